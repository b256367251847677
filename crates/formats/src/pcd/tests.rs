use super::*;
use crate::error::FormatError;

const HEAD: &str = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x id _ v\nSIZE 4 2 1 8\n\
                    TYPE F I U F\nCOUNT 1 1 3 2\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\n";
const X: [f32; 3] = [1.5, -2.25, f32::NAN];
const ID: [i16; 3] = [-1, 300, i16::MIN];
const V: [[f64; 2]; 3] = [[0.1, 9.0], [1e300, 9.0], [-0.0, 9.0]];

fn columns() -> Vec<u8> {
    let x = X.iter().flat_map(|x| x.to_le_bytes());
    let id = ID.iter().flat_map(|id| id.to_le_bytes());
    let v = V.iter().flatten().flat_map(|v| v.to_le_bytes());
    x.chain(id).chain([7; 9]).chain(v).collect()
}

fn rows() -> Vec<u8> {
    let row = |i: usize| {
        let v = V[i].iter().flat_map(|v| v.to_le_bytes());
        X[i].to_le_bytes().into_iter().chain(ID[i].to_le_bytes()).chain([7; 3]).chain(v).collect()
    };
    (0..3).flat_map(|i: usize| -> Vec<u8> { row(i) }).collect()
}

fn file(data: &str, body: &[u8]) -> Vec<u8> {
    [HEAD.as_bytes(), format!("DATA {data}\n").as_bytes(), body].concat()
}

/// Literal runs alone are LZF too.
fn literal(bytes: &[u8]) -> Vec<u8> {
    let runs = bytes.chunks(32).flat_map(|run| [&[run.len() as u8 - 1], run].concat());
    runs.collect()
}

fn packed(packed: &[u8], unpacked: usize) -> Vec<u8> {
    let words = [packed.len(), unpacked].map(|n| (n as u32).to_le_bytes());
    file("binary_compressed", &[&words.concat(), packed].concat())
}

fn assert_whole(file: &[u8]) {
    let cloud = PointCloud::parse(file).unwrap();
    assert_eq!((cloud.len(), cloud.is_empty()), (3, false));
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    let x = cloud.column("x").unwrap();
    assert_eq!(x[..2], [1.5, -2.25]);
    assert!(x[2].is_nan());
    assert_eq!(cloud.need("id").unwrap(), [-1.0, 300.0, -32768.0]);
    assert_eq!(bits(cloud.column("v").unwrap()), bits(vec![0.1, 1e300, -0.0]));
    assert_eq!(cloud.column("y"), None);
    let error = cloud.need("rcs").unwrap_err().to_string();
    assert!(error.contains("rcs") && error.contains("x id _ v"), "{error}");
}

#[test]
fn all_three_ways_of_storing_points_are_read() {
    assert_whole(&file("binary", &rows()));
    let text = "1.5 -1 7 7 7 0.1 9\r\n-2.25 300 7 7 7 1e300 9\n\nnan -32768 7 7 7 -0.0 9";
    assert_whole(&file("ascii", text.as_bytes()));
    assert_whole(&packed(&literal(&columns()), columns().len()));
}

#[test]
fn copies_of_lzf_reach_back_and_into_themselves() {
    // Three bytes, then twelve more of them by one copy, then a long one of a single byte.
    let text = [2, b'a', b'b', b'c', 0b1110_0000, 3, 2, 0, b'z', 0b1110_0000, 255, 0];
    let unpacked = lzf::unpack(&text, 3 + 12 + 1 + 264).unwrap();
    assert_eq!(unpacked[..16], *b"abcabcabcabcabcz");
    assert!(unpacked[16..].iter().all(|byte| *byte == b'z'));
    for length in 0..text.len() {
        assert!(lzf::unpack(&text[..length], 280).is_err());
    }
    for (bad, length) in
        [(&[0x20, 0][..], 3), (&[0, b'a', 0x20, 1], 4), (&[0, b'a'], 2), (&[1, 1, 1], 1)]
    {
        assert!(lzf::unpack(bad, length).is_err(), "{bad:?}");
    }
    // A bomb is refused before anything is allocated.
    assert!(lzf::unpack(&[0x20, 0], usize::MAX).is_err());
}

#[test]
fn what_is_cut_or_breaks_the_rules_is_refused_where_it_stands() {
    for whole in [
        file("binary", &rows()),
        file("ascii", b"1 1 7 7 7 1 9\n1 1 7 7 7 1 9\n1 1 7 7 7 1 9"),
        packed(&literal(&columns()), columns().len()),
    ] {
        PointCloud::parse(&whole).unwrap();
        for length in 0..whole.len() {
            // The last number of a text may be cut to another number.
            let cut = PointCloud::parse(&whole[..length]);
            assert!(cut.is_err() || length > whole.len() - 2, "{length}");
        }
    }
    let message = |text: &str| PointCloud::parse(text.as_bytes()).unwrap_err().to_string();
    let head = |from: &str, to: &str| message(&(HEAD.replace(from, to) + "DATA binary\n"));
    for (given, part) in [
        (head("0.7\nF", "0.6\nF"), "VERSION is 0.6; expected 0.7"),
        (head("SIZE 4", "SIZE 3"), "type of x is F of 3"),
        (head("SIZE 4 2 1 8", "SIZE 4"), "SIZE is 1; expected one for each of 4 fields"),
        (head("COUNT 1", "COUNT -1"), "COUNT is -1"),
        (head("COUNT 1", "COUNT 99999"), "at most 65536 bytes a point"),
        (head("COUNT 1 1 3 2", "COUNT 0 0 0 0"), "at least one number a point"),
        (head("POINTS 3", "POINTS 99999999999999999999"), "POINTS is 9999"),
        (head("POINTS 3", "POINTS 18446744073709551615"), "expected 18446744073709551615 points"),
        (head("POINTS 3", "POINTS 4"), "expected 4 points of 25 bytes"),
        (head("FIELDS x id _ v", "FIELDS"), "a FIELDS line"),
        (head("VIEWPOINT", "VIEW"), "a line of PCD 0.7"),
        (message(&(HEAD.to_owned() + "DATA zip\n")), "DATA is zip"),
        (message("not a cloud\n"), "at byte 0: the header is not"),
        (message(""), "a DATA line at its end"),
        (message(&"# comment\n".repeat(10_000)), "a DATA line at its end"),
        (message(&(HEAD.to_owned() + "DATA ascii\n1 2 3\n")), "7 numbers"),
        (
            message(&(HEAD.to_owned() + "DATA ascii\n1 2 3 4 5 6 x\n")),
            "a point is x; expected numbers",
        ),
        (message(&(HEAD.to_owned() + "DATA ascii\n" + &"1 2 3 4 5 6 7\n".repeat(4))), "expected 3"),
    ] {
        assert!(given.contains(part), "{given:?} does not say {part:?}");
    }
    let error = PointCloud::parse(&packed(&literal(&columns()), columns().len() + 1)).unwrap_err();
    assert!(
        matches!(&error, FormatError::Binary { what, .. } if what.contains("unpacked")),
        "{error}"
    );
    let bomb = HEAD.replace("POINTS 3", "POINTS 171798691") + "DATA binary_compressed\n";
    let bomb =
        [bomb.as_bytes(), &[2, 0, 0, 0], &4_294_967_275_u32.to_le_bytes(), &[0x20, 0]].concat();
    assert!(PointCloud::parse(&bomb).unwrap_err().to_string().contains("so few bytes"));
}

#[test]
fn an_empty_cloud_has_columns_without_numbers() {
    let empty = HEAD.replace("POINTS 3", "POINTS 0");
    for data in ["ascii", "binary"] {
        let file = format!("{empty}DATA {data}\n");
        let cloud = PointCloud::parse(file.as_bytes()).unwrap();
        assert_eq!((cloud.is_empty(), cloud.column("x")), (true, Some(vec![])));
    }
    let file = HEAD.replace("POINTS 3\n", "").replace("WIDTH 3", "WIDTH 0") + "DATA binary\n";
    assert!(PointCloud::parse(file.as_bytes()).unwrap().is_empty());
}
