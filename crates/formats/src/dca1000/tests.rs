use super::*;
use crate::mmwave_cfg::AdcFormat;
use boresight_core::{Random, Waveform};
use ndarray::{Array5, s};

const CFG: &[u8] = include_bytes!("../../../../recordings/awr1642/profile.cfg");
const BIN: &[u8] =
    include_bytes!("../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");

fn config() -> RadarConfig {
    RadarConfig::parse(CFG).unwrap()
}

#[test]
fn the_recording_holds_eight_frames() {
    let capture = Capture::new(BIN, &config()).unwrap();
    assert_eq!((capture.frames(), capture.trailing_bytes()), (8, 0));
    assert_eq!(capture.shape(), [16, 2, 4, 256]);
    assert_eq!(capture.remarks(), []);
    let frame = capture.frame(7).unwrap();
    assert_eq!(frame.samples.dim(), (16, 2, 4, 256));
    assert_eq!(frame.clipped, 0);
    let error = capture.frame(8).err();
    assert!(matches!(error, Some(FormatError::Argument(_))), "{error:?}");
}

#[test]
fn samples_stand_where_the_layout_says() {
    // Number n of the file is n: loop 1, transmitter 0, receiver 2, sample 5 is in group
    // ((1*2 + 0)*4 + 2)*128 + 2, second of its pair.
    let bytes: Vec<u8> = (0..65_536_u32).flat_map(|n| (n as i16).to_le_bytes()).collect();
    let mut config = config();
    let group = ((2 * 4) + 2) * 128 + 2;
    let z = Capture::new(&bytes, &config).unwrap().frame(0).unwrap().samples[[1, 0, 2, 5]];
    let expected = |n: usize| (4 * group + n) as f32 / 32768.0;
    assert_eq!(z, Complex32::new(expected(1), expected(3)));
    config.adc.q_first = true;
    let z = Capture::new(&bytes, &config).unwrap().frame(0).unwrap().samples[[1, 0, 2, 5]];
    assert_eq!(z, Complex32::new(expected(3), expected(1)));
}

#[test]
fn clipped_samples_are_counted() {
    let mut bytes = BIN[..131_072].to_vec();
    bytes[0..2].copy_from_slice(&i16::MAX.to_le_bytes());
    bytes[4..6].copy_from_slice(&i16::MIN.to_le_bytes());
    bytes[8..10].copy_from_slice(&i16::MIN.to_le_bytes());
    let frame = Capture::new(&bytes, &config()).unwrap().frame(0).unwrap();
    assert_eq!(frame.clipped, 2);
    assert_eq!(frame.samples[[0, 0, 0, 0]], Complex32::new(32767.0 / 32768.0, -1.0));
}

#[test]
fn captures_that_do_not_match_say_by_how_much() {
    let error = Capture::new(&BIN[..131_071], &config()).unwrap_err();
    let FormatError::NoWholeFrame { expected, given, .. } = error else { panic!("{error}") };
    assert_eq!((expected, given), (131_072, 131_071));
    let error = Capture::new(&[], &config()).unwrap_err();
    assert!(matches!(error, FormatError::NoWholeFrame { given: 0, .. }), "{error}");

    let capture = Capture::new(&BIN[..300_000], &config()).unwrap();
    assert_eq!((capture.frames(), capture.trailing_bytes()), (2, 37_856));
    assert_eq!(capture.remarks()[0].code, "trailing-bytes");

    let text = String::from_utf8_lossy(CFG).replace("frameCfg 0 1 16 0", "frameCfg 0 1 16 9");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(Capture::new(BIN, &config).unwrap().remarks()[0].code, "frame-count");
}

#[test]
fn layouts_that_cannot_be_read_are_refused() {
    let refused = |config: &RadarConfig| {
        assert!(matches!(Capture::new(BIN, config), Err(FormatError::Layout { .. })));
    };
    let mut odd = config();
    odd.waveform.samples = 255;
    refused(&odd);
    odd.adc.layout = Layout::FourLane;
    assert!(Capture::new(BIN, &odd).is_ok(), "samples of four lanes stand by themselves");
    let mut many = odd.clone();
    many.receivers = vec![0, 7];
    refused(&many);
}

/// A configuration of a few chirps in a layout.
fn small(layout: Layout, sampling: Sampling) -> RadarConfig {
    let mut config = config();
    config.waveform = Waveform { samples: 6, loops: 2, sampling, ..config.waveform };
    config.adc.layout = layout;
    match layout {
        Layout::Cascade => config.receivers = CASCADE_RECEIVERS.to_vec(),
        _ => config.receivers = vec![0, 2, 3],
    }
    config
}

/// Number n of the bytes is n.
fn counting(config: &RadarConfig) -> Vec<u8> {
    let words = config.frame_bytes() / 2;
    (0..words).flat_map(|n| (n as i16).to_le_bytes()).collect()
}

/// Words of the I and the Q of loop 1, transmitter 0, receiver number 2, sample 5.
fn words_of_one(layout: Layout, sampling: Sampling) -> [f32; 2] {
    let config = small(layout, sampling);
    let bytes = counting(&config);
    let capture = Capture::new(&bytes, &config).unwrap();
    assert_eq!((capture.frames(), capture.trailing_bytes()), (1, 0));
    let at = config.receivers.iter().position(|&number| number == 2).unwrap();
    let z = capture.frame(0).unwrap().samples[[1, 0, at, 5]];
    [z.re * 32768.0, z.im * 32768.0]
}

#[test]
fn four_lanes_have_the_receivers_of_a_sample_together() {
    // Chirp 2 of four; 6 samples of 4 lanes, used or not, all I before all Q.
    let sample = (2 * 6 + 5) as f32;
    let complex = words_of_one(Layout::FourLane, Sampling::Complex);
    assert_eq!(complex, [8.0 * sample + 2.0, 8.0 * sample + 6.0]);
    let real = words_of_one(Layout::FourLane, Sampling::Real);
    assert_eq!(real, [4.0 * sample + 2.0, 0.0]);
}

#[test]
fn real_samples_of_two_lanes_follow_each_other() {
    // Chirp 2, the second of three receivers.
    let row = (2 * 3 + 1) as f32;
    assert_eq!(words_of_one(Layout::TwoLane, Sampling::Real), [6.0 * row + 5.0, 0.0]);
    assert_eq!(
        words_of_one(Layout::TwoLane, Sampling::Complex),
        [12.0 * row + 9.0, 12.0 * row + 11.0]
    );
}

#[test]
fn chips_of_a_cascade_follow_each_other_in_a_frame() {
    // Receiver 2 is of the first chip, whose 4 chirps x 6 samples x 4 receivers come first.
    let first = (2 * 6 + 5) as f32 * 8.0 + 4.0;
    assert_eq!(words_of_one(Layout::Cascade, Sampling::Complex), [first, first + 1.0]);
    let config = small(Layout::Cascade, Sampling::Complex);
    let bytes = counting(&config);
    let frame = Capture::new(&bytes, &config).unwrap().frame(0).unwrap();
    // The leftmost receiver of the board is the first of the third slave.
    assert_eq!(frame.samples[[0, 0, 0, 0]].re * 32768.0, (3 * 4 * 6 * 8) as f32);
    assert_eq!(frame.samples[[0, 0, 4, 0]].re, 0.0);
}

#[test]
fn what_is_written_is_read_back() {
    let mut random = Random::new(4, 0);
    for layout in [Layout::TwoLane, Layout::FourLane, Layout::Cascade] {
        for sampling in [Sampling::Complex, Sampling::Real] {
            for q_first in [false, true] {
                let mut config = small(layout, sampling);
                config.adc.q_first = q_first;
                let [loops, tx, rx] = [2, 2, config.receivers.len()];
                let mut value = || (random.uniform(-32768.0, 32767.0).round() / 32768.0) as f32;
                let frames = Array5::from_shape_fn((3, loops, tx, rx, 6), |_| {
                    let im = value();
                    let im = if sampling == Sampling::Real { 0.0 } else { im };
                    Complex32::new(value(), im)
                });
                let bytes = write(frames.view(), &config).unwrap();
                assert_eq!(bytes.len() as u64, 3 * config.frame_bytes());
                let capture = Capture::new(&bytes, &config).unwrap();
                for (k, frame) in frames.outer_iter().enumerate() {
                    assert_eq!(capture.frame(k).unwrap().samples, frame, "{layout:?} {sampling:?}");
                }
                assert!(write(frames.slice(s![.., .., .., .., 1..]), &config).is_err());
            }
        }
    }
}

#[test]
fn written_numbers_keep_within_the_converter() {
    let config = small(Layout::TwoLane, Sampling::Complex);
    let loud = Array5::from_elem((1, 2, 2, 3, 6), Complex32::new(2.0, -2.0));
    let bytes = write(loud.view(), &config).unwrap();
    let frame = Capture::new(&bytes, &config).unwrap().frame(0).unwrap();
    assert_eq!(frame.clipped, 72);
    assert_eq!(frame.samples[[0, 0, 0, 0]], Complex32::new(32767.0 / 32768.0, -1.0));
}

fn index(data_bytes: usize, frames: &[(u32, u64)]) -> Vec<u8> {
    let mut bytes = vec![0; 12];
    bytes.extend_from_slice(&(frames.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&(data_bytes as u64).to_le_bytes());
    for (size, time) in frames {
        bytes.extend_from_slice(&[0; 28]);
        bytes.extend_from_slice(&size.to_le_bytes());
        bytes.extend_from_slice(&time.to_le_bytes());
        bytes.extend_from_slice(&[0; 8]);
    }
    bytes
}

/// Names and bytes.
type Files = Vec<(String, Vec<u8>)>;

/// The files of a recording of three frames, with names, and the capture they are of.
fn recorded() -> (RadarConfig, Files, Vec<u8>) {
    let config = small(Layout::Cascade, Sampling::Complex);
    let each = config.frame_bytes() as usize;
    let bytes: Vec<u8> = (0..3 * each).map(|n| (n * n / 7) as u8).collect();
    let chips = cascade::split(&bytes, &config).unwrap();
    let times = [(each as u32 / 4, 1000), (each as u32 / 4, 2000), (each as u32 / 4, 3001)];
    let mut files = vec![];
    for (name, chip) in cascade::CHIP_NAMES.iter().zip(chips) {
        files.push((format!("Folder/{name}_0000_idx.bin"), index(chip.len(), &times)));
        files.push((format!("Folder/{name}_0000_data.bin"), chip));
    }
    files.reverse();
    (config, files, bytes)
}

fn join(files: &[(String, Vec<u8>)], config: &RadarConfig) -> Result<cascade::Joined, FormatError> {
    let files: Vec<_> = files.iter().map(|(name, bytes)| (&**name, &**bytes)).collect();
    cascade::join(&files, config)
}

#[test]
fn files_of_a_cascade_make_one_capture() {
    let (config, mut files, bytes) = recorded();
    let joined = join(&files, &config).unwrap();
    assert_eq!((joined.bytes, joined.remarks), (bytes.clone(), vec![]));
    // A recording that goes on in further files, without indices.
    files.retain(|(name, _)| name.ends_with("data.bin"));
    let next = files.clone().into_iter().map(|(name, file)| (name.replace("0000", "0001"), file));
    let both: Vec<_> = next.chain(files.clone()).collect();
    assert_eq!(join(&both, &config).unwrap().bytes, [bytes.clone(), bytes].concat());
}

#[test]
fn files_that_make_no_cascade_are_refused() {
    let (config, files, _) = recorded();
    let without = |part: &str| {
        files.iter().filter(|(name, _)| !name.contains(part)).cloned().collect::<Vec<_>>()
    };
    let refused = |files: &[(String, Vec<u8>)], word: &str| {
        let error = join(files, &config).unwrap_err();
        assert!(matches!(error, FormatError::Parts { .. }), "{error:?}");
        assert!(error.to_string().contains(word), "{error}");
    };
    refused(&[], "none");
    refused(&without("slave2_0000_data"), "no slave2_0000_data.bin");
    let mut short = files.clone();
    short.iter_mut().find(|(name, _)| name.contains("slave1_0000_data")).unwrap().1.pop();
    refused(&short, "bytes of the chips' files");
    let mut twice = files.clone();
    twice.push(files[0].clone());
    refused(&twice, "once");
    for name in
        ["adc_data.bin", "slave4_0000_data.bin", "master_x_data.bin", "master_0000_data.dat"]
    {
        let mut odd = files.clone();
        odd.push((name.into(), vec![]));
        refused(&odd, name);
    }
    let single = join(&files, &self::config()).unwrap_err();
    assert!(single.to_string().contains("single chip"), "{single}");
}

#[test]
fn indices_are_checked_against_the_data() {
    let (config, files, _) = recorded();
    let with = |bytes: Vec<u8>| {
        let mut files = files.clone();
        files.iter_mut().find(|(name, _)| name.contains("slave3_0000_idx")).unwrap().1 = bytes;
        join(&files, &config)
    };
    let each = config.frame_bytes() as u32 / 4;
    let codes = |joined: cascade::Joined| -> Vec<&str> {
        joined.remarks.iter().map(|remark| remark.code).collect()
    };
    let whole = 3 * each as usize;
    let good = [(each, 0), (each, 1000), (each, 2000)];
    assert_eq!(codes(with(index(whole, &good)).unwrap()), [""; 0]);
    assert_eq!(codes(with(index(whole + 1, &good)).unwrap()), ["cascade-index"]);
    let sizes = [(each, 0), (each - 4, 1000), (each, 2000)];
    assert_eq!(codes(with(index(whole, &sizes)).unwrap()), ["cascade-index"]);
    // It lost the second frame: two of the three are not of the same moment.
    let lost = [(each, 0), (each, 2000), (each, 3000)];
    let joined = with(index(whole, &lost)).unwrap();
    assert!(joined.remarks[0].message.starts_with("2 of 3 frames"), "{joined:?}");
    for bytes in [vec![], vec![0; 23], index(whole, &good)[..100].to_vec(), {
        let mut claims = index(whole, &good);
        claims[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        claims
    }] {
        let error = with(bytes).unwrap_err();
        assert!(matches!(error, FormatError::Binary { format: "cascade index", .. }), "{error}");
    }
}

fn settled(config: &RadarConfig, options: ReadingOptions) -> (Settled, Vec<&'static str>) {
    let settled = Settled::new(BIN, config, &options).unwrap();
    let codes = settled.remarks.iter().map(|remark| remark.code).collect();
    (settled, codes)
}

#[test]
fn the_recording_tells_its_order_of_i_and_q() {
    let right = config();
    let swapped = RadarConfig { adc: AdcFormat { q_first: true, ..right.adc }, ..right.clone() };
    let as_configured = ReadingOptions::default();
    let (read, codes) = settled(&right, as_configured);
    let sides = read.evidence.sides.unwrap();
    println!("recording: {sides:?}");
    assert_eq!((sides.swapped, &*codes), (Some(false), &[][..]));
    let (read, codes) = settled(&swapped, as_configured);
    let mirrored = read.evidence.sides.unwrap();
    assert_eq!((mirrored.swapped, &*codes), (Some(true), &["iq-swapped"][..]));
    assert!((mirrored.asymmetry_db + sides.asymmetry_db).abs() < 1e-3);
    assert!(read.config.adc.q_first, "only told");

    let auto = ReadingOptions { iq_order: IqOrder::Auto, ..as_configured };
    let (read, codes) = settled(&swapped, auto);
    assert_eq!((read.config.adc.q_first, &*codes), (false, &["iq-order-found"][..]));
    assert_eq!(read.evidence.sides.unwrap().swapped, Some(false));
    let (read, codes) = settled(&right, auto);
    assert_eq!((read.config.adc.q_first, &*codes), (false, &[][..]));

    let asked = ReadingOptions { iq_order: IqOrder::Qi, ..as_configured };
    let (read, codes) = settled(&right, asked);
    assert_eq!((read.config.adc.q_first, &*codes), (true, &["iq-swapped"][..]));
    let asked = ReadingOptions { iq_order: IqOrder::Iq, ..as_configured };
    assert_eq!(settled(&swapped, asked).1, [""; 0]);
}

#[test]
fn the_recording_tells_that_it_has_two_lanes() {
    let mut other = config();
    other.adc.layout = Layout::FourLane;
    let (read, codes) = settled(&other, ReadingOptions::default());
    assert_eq!(codes, ["other-lanes"]);
    println!("recording as of four lanes: {:?}", read.evidence);
    assert_eq!(read.evidence.other_lanes.unwrap().0, Layout::TwoLane);
    let asked = ReadingOptions { lanes: Lanes::Two, ..ReadingOptions::default() };
    assert_eq!(settled(&other, asked).1, [""; 0]);
    let asked = ReadingOptions { lanes: Lanes::Four, ..ReadingOptions::default() };
    assert_eq!(settled(&config(), asked).1, ["other-lanes"]);
    let cascaded = small(Layout::Cascade, Sampling::Complex);
    assert!(matches!(asked.apply(&mut cascaded.clone()), Err(FormatError::Layout { .. })));
}

#[test]
fn noise_tells_nothing() {
    let auto = ReadingOptions { iq_order: IqOrder::Auto, ..ReadingOptions::default() };
    for seed in 0..40 {
        let mut random = Random::new(seed, 0);
        let mut config = config();
        // From 4 chirps of 16 samples to 64 of 256.
        let (loops, samples) = [(1, 16), (1, 64), (4, 256), (16, 256)][seed as usize % 4];
        config.waveform = Waveform { samples, loops, transmitters: 1, ..config.waveform };
        let noise = Array5::from_shape_fn((1, loops, 1, 4, samples), |_| {
            let z = random.complex_normal(1e-4);
            Complex32::new(z.re as f32, z.im as f32)
        });
        let bytes = write(noise.view(), &config).unwrap();
        let read = Settled::new(&bytes, &config, &auto).unwrap();
        assert_eq!(read.evidence.sides.unwrap().swapped, None, "{:?}", read.evidence);
        assert_eq!(read.remarks.iter().map(|r| r.code).collect::<Vec<_>>(), ["iq-order-not-found"]);
    }
    let silent = vec![0; 131_072];
    let read = Settled::new(&silent, &config(), &auto).unwrap();
    assert_eq!((read.evidence.sides, read.remarks), (None, vec![]));
}
