use super::made::{Cdr, HEADER, LINE, TIME, definition};
use super::{Definitions, Encoding, Kind, Many, NumberKind, Numbers, Value, decode};
use proptest::prelude::*;

const EVERYTHING: &str = "\
# A message of every kind.
std_msgs/Header header
int8 KIND_A = 1   # a constant
string NAME=\"a # in it\"
bool truth
uint8[<=4] some
float64 deep 1.5
string<=10 short \"x\"
Inner[2] pair
Inner[] many
float32[3] three
string[] texts
uint64 large
";

fn everything() -> Definitions {
    let inner = ("own_msgs/Inner", "uint16 a\nown_msgs/Deep deep");
    let deep = ("own_msgs/msg/Deep", "int64 b");
    Definitions::parse(definition(EVERYTHING, &[HEADER, TIME, inner, deep]).as_bytes()).unwrap()
}

fn written(cdr: Cdr) -> Vec<u8> {
    let inner = |cdr: Cdr, a: u16| cdr.u16(a).f64(f64::from_bits(u64::from(a) + 9));
    let cdr = cdr.header(5_000_000_007, "radar").u8(1).bytes(&[1, 2, 3]).f64(-2.5).text("short");
    let cdr = inner(inner(cdr, 1), 2).u32(1);
    let cdr = inner(cdr, 3).f32(0.5).f32(1.5).f32(2.5).u32(2).text("a").text("");
    cdr.f64(f64::from_bits(1 << 40)).done()
}

#[test]
fn every_kind_of_field_is_read_in_both_orders_of_bytes_and_as_ros_1_has_it() {
    let definitions = everything();
    for (bytes, encoding) in
        [(written(Cdr::new()), Encoding::Cdr), (written(Cdr::big_endian()), Encoding::Cdr)]
    {
        let value = decode(&definitions, &bytes, encoding).unwrap();
        let number = |path: &str| value.number(&definitions.path(0, path).unwrap());
        assert_eq!(number("header.stamp.sec"), Some(5.0));
        assert_eq!(number("header.stamp.nanosec"), Some(7.0));
        assert_eq!(value.text(&definitions.path(0, "header.frame_id").unwrap()), Some("radar"));
        assert_eq!((number("truth"), number("deep")), (Some(1.0), Some(-2.5)));
        assert_eq!(number("large"), Some((1_u64 << 40) as f64));
        let path = |name| definitions.path(0, name).unwrap();
        assert_eq!(value.bytes(&path("some")), Some(&[1, 2, 3][..]));
        assert_eq!(value.text(&path("short")), Some("short"));
        let inner = |a: f64| {
            Value::Struct(
                vec![a, a + 9.0]
                    .into_iter()
                    .enumerate()
                    .map(|(k, n)| {
                        if k == 0 {
                            Value::Number(n)
                        } else {
                            Value::Struct(vec![Value::Number(n)])
                        }
                    })
                    .collect(),
            )
        };
        assert_eq!(value.list(&path("pair")), [inner(1.0), inner(2.0)]);
        assert_eq!(value.list(&path("many")), [inner(3.0)]);
        let Some(Value::Numbers(three)) = value.at(&path("three")) else { panic!("numbers") };
        assert_eq!(three.iter().collect::<Vec<_>>(), [0.5, 1.5, 2.5]);
        let texts = ["a", ""].map(|text| Value::Text(text.into()));
        assert_eq!(value.list(&path("texts")), texts);
        for end in 0..bytes.len() {
            assert!(decode(&definitions, &bytes[..end], encoding).is_err(), "{end}");
        }
    }
    let old = Definitions::parse(
        definition(
            "Header header\nfloat64 x\ntime at\nduration[] for",
            &[("std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id")],
        )
        .as_bytes(),
    )
    .unwrap();
    let bytes = Cdr::ros1().header(3_000_000_001, "a").f64(7.0).u32(9).u32(8).u32(0).done();
    let value = decode(&old, &bytes, Encoding::Ros1).unwrap();
    let number = |path: &str| value.number(&old.path(0, path).unwrap());
    assert_eq!(
        (number("header.stamp.nanosec"), number("x"), number("at.sec")),
        (Some(1.0), Some(7.0), Some(9.0))
    );
}

/// With alignment to 4 at most, as the second version of CDR has it.
#[test]
fn the_second_version_of_cdr_aligns_less() {
    let definitions = Definitions::parse(b"uint8 a\nfloat64 b").unwrap();
    let bytes = [&[0, 7, 0, 0, 1, 0, 0, 0][..], &2.5_f64.to_le_bytes()].concat();
    assert_eq!(decode(&definitions, &bytes, Encoding::Cdr).unwrap().number(&[1]), Some(2.5));
    let old = [&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0][..], &2.5_f64.to_le_bytes()].concat();
    assert_eq!(decode(&definitions, &old, Encoding::Cdr).unwrap().number(&[1]), Some(2.5));
    let other = [&[0, 3][..], &old[2..]].concat();
    assert!(decode(&definitions, &other, Encoding::Cdr).unwrap_err().contains("plain CDR"));
}

#[test]
fn a_type_without_fields_takes_a_byte() {
    let text = definition("a_msgs/Empty one\nuint8 two", &[("a_msgs/Empty", "# nothing")]);
    let definitions = Definitions::parse(text.as_bytes()).unwrap();
    let value = decode(&definitions, &[0, 1, 0, 0, 9, 4], Encoding::Cdr).unwrap();
    assert_eq!(value.number(&[1]), Some(4.0));
}

#[test]
fn definitions_that_are_none_are_refused_and_rings_end() {
    for text in ["float32", "float32[ x", "float32[x] x", "other_msgs/Missing a", "a b c=1\n?"] {
        assert_eq!(Definitions::parse(text.as_bytes()), None, "{text}");
    }
    assert!(Definitions::parse(b"").unwrap().root().fields.is_empty());
    let ring = format!("own_msgs/A a\n{LINE}MSG: own_msgs/A\nown_msgs/A a\n");
    let ring = Definitions::parse(ring.as_bytes()).unwrap();
    assert!(decode(&ring, &[0, 1, 0, 0], Encoding::Cdr).unwrap_err().contains("nested"));
    // Each type a thousand of the next, down to nothing.
    let mut text = "m/A0[1000] a\n".to_owned();
    for k in 0..9 {
        text += &format!("{LINE}MSG: m/A{k}\nm/A{}[1000] a\n", k + 1);
    }
    text += &format!("{LINE}MSG: m/A9\n");
    let wide = Definitions::parse(text.as_bytes()).unwrap();
    assert!(decode(&wide, &[], Encoding::Ros1).unwrap_err().contains("too many"));
    assert_eq!(wide.get(1).fields[0].many, Many::Fixed(1000));
}

#[test]
fn numbers_are_read_at_their_ends() {
    for (kind, bytes, number) in [
        (NumberKind::I8, vec![0x80], -128.0),
        (NumberKind::Bool, vec![1], 1.0),
        (NumberKind::I16, vec![0, 0x80], -32768.0),
        (NumberKind::I32, vec![0xff; 4], -1.0),
        (NumberKind::U32, vec![0xff; 4], 4_294_967_295.0),
        (NumberKind::I64, vec![0xff; 8], -1.0),
        (NumberKind::U64, vec![0xff; 8], 18_446_744_073_709_551_615.0),
        (NumberKind::F32, 1.5_f32.to_le_bytes().to_vec(), 1.5),
        (NumberKind::F64, (-0.1_f64).to_le_bytes().to_vec(), -0.1),
    ] {
        assert_eq!(kind.size(), bytes.len());
        assert_eq!(kind.read(&bytes, false), Some(number));
        let turned: Vec<_> = bytes.iter().rev().copied().collect();
        assert_eq!(kind.read(&turned, true), Some(number));
        assert_eq!(kind.read(&bytes[1..], false), None);
        let twice = [&bytes[..], &bytes].concat();
        let numbers = Numbers { bytes: &twice, kind, is_big_endian: false };
        assert_eq!(numbers.iter().collect::<Vec<_>>(), [number; 2]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_message_is_decoded_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400), kind in 0..2_u8) {
        let definitions = everything();
        let head = [&[0, kind, 0, 0][..], &bytes].concat();
        let _ = decode(&definitions, &head, Encoding::Cdr);
        let _ = decode(&definitions, &bytes, Encoding::Ros1);
    }

    #[test]
    fn any_definition_is_read_or_refused(lines in proptest::collection::vec("[a-zA-Z0-9_/\\[\\]<=# :]{0,24}", 0..30)) {
        if let Some(definitions) = Definitions::parse(lines.join("\n").as_bytes()) {
            for field in &definitions.root().fields {
                if let Kind::Struct(place) = field.kind {
                    let _ = definitions.get(place);
                }
            }
            let _ = decode(&definitions, &[0; 64], Encoding::Ros1);
        }
    }
}
