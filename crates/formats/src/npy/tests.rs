use super::*;
use crate::error::FormatError;
use boresight_core::InputError;

fn file(header: &str, body: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(body);
    bytes
}

#[test]
fn what_is_written_is_read() {
    let data = [Complex64::new(1.0, -2.0), Complex64::new(0.5, 3.0)];
    let bytes = write(&[2, 1], &data).unwrap();
    // What NumPy 2 writes for the same array, byte for byte.
    let header = "{'descr': '<c16', 'fortran_order': False, 'shape': (2, 1), }";
    assert_eq!(bytes.len(), 128 + 32);
    assert_eq!(&bytes[10..10 + header.len()], header.as_bytes());
    let array = NpyArray::parse(&bytes).unwrap();
    assert_eq!(array, NpyArray { shape: vec![2, 1], data: NpyData::Complex64(data.to_vec()) });

    let vector = NpyArray::parse(&write(&[3], &[1.0_f32, 2.0, 3.0]).unwrap()).unwrap();
    assert_eq!(vector.to_f64().unwrap(), [1.0, 2.0, 3.0]);
    let number = NpyArray::parse(&write(&[], &[4.0_f64]).unwrap()).unwrap();
    assert_eq!((number.shape.len(), number.to_f64().unwrap()), (0, vec![4.0]));
    let c8 = [Complex32::new(0.25, -1.0)];
    assert_eq!(NpyArray::parse(&write(&[1, 1], &c8).unwrap()).unwrap().to_complex32(), c8);
    let empty = NpyArray::parse(&write::<f64>(&[0, 5], &[]).unwrap()).unwrap();
    assert_eq!(empty.shape, [0, 5]);
    let short = write(&[2], &[1.0_f64]).unwrap_err();
    assert!(matches!(short, FormatError::Argument(InputError::Shape { .. })), "{short}");
}

#[test]
fn fortran_order_becomes_c_order() {
    let header = "{'shape': (2, 3), 'fortran_order': True, 'descr': '<i2'}";
    let body: Vec<u8> = [11_i16, 21, 12, 22, 13, 23].iter().flat_map(|v| v.to_le_bytes()).collect();
    let array = NpyArray::parse(&file(header, &body)).unwrap();
    assert_eq!(array.data, NpyData::Integer(vec![11, 12, 13, 21, 22, 23]));
}

#[test]
fn every_number_type_is_read() {
    for (descr, body, value) in [
        ("|b1", vec![1], 1.0),
        ("|i1", vec![0xff], -1.0),
        ("|u1", vec![0xff], 255.0),
        ("<i2", vec![0xfe, 0xff], -2.0),
        ("<u2", vec![0xfe, 0xff], 65_534.0),
        ("<i4", (-7_i32).to_le_bytes().to_vec(), -7.0),
        ("<u4", u32::MAX.to_le_bytes().to_vec(), 4_294_967_295.0),
        ("<i8", (-1_i64).to_le_bytes().to_vec(), -1.0),
        ("<u8", 5_u64.to_le_bytes().to_vec(), 5.0),
        ("<f4", 1.5_f32.to_le_bytes().to_vec(), 1.5),
        ("<f8", 1.5_f64.to_le_bytes().to_vec(), 1.5),
    ] {
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1L,), }}\n");
        let array = NpyArray::parse(&file(&header, &body)).unwrap();
        assert_eq!(array.to_f64().unwrap(), [value], "{descr}");
    }
}

#[test]
fn wrong_files_say_where() {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }\n";
    let body = [0; 16];
    let whole = file(header, &body);
    assert!(NpyArray::parse(&whole).is_ok());
    for length in 0..whole.len() {
        let error = NpyArray::parse(&whole[..length]).unwrap_err();
        assert!(matches!(error, FormatError::Binary { .. }), "{length}: {error}");
    }
    let broken = |from: &str, to: &str| file(&header.replace(from, to), &body);
    for (bytes, word) in [
        (broken("<f8", ">f8"), "number type"),
        (broken("<f8", "<f3"), "number type"),
        (broken("'<f8'", "[('a', '<f8')]"), "plain number type"),
        (broken("False", "Maybe"), "True or False"),
        (broken("(2,)", "(18446744073709551615, 18446744073709551615)"), "size of the data"),
        (broken("(2,)", "(99999999999999999999999999,)"), "memory"),
        (broken("(2,)", "(-2,)"), "length of an axis"),
        (broken("(2,)", "(3,)"), "24 bytes"),
        (broken("'shape': (2,), ", ""), "the key shape"),
        (broken("{", ""), "a dictionary"),
        (b"not an array".to_vec(), "magic"),
    ] {
        let error = NpyArray::parse(&bytes).unwrap_err();
        assert!(matches!(error, FormatError::Binary { .. }));
        assert!(error.to_string().contains(word), "{word}: {error}");
    }
    let huge = b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}".to_vec();
    assert!(NpyArray::parse(&huge).unwrap_err().to_string().contains("4294967295"));
    let too_large = file("{'descr': '<u8', 'fortran_order': False, 'shape': (1,)}", &[0xff; 8]);
    assert!(NpyArray::parse(&too_large).unwrap_err().to_string().contains("2^63"));
}

#[test]
fn a_header_of_more_axes_than_numpy_has_is_refused() {
    let of = |axes: usize| {
        let shape = "1,".repeat(axes);
        file(&format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape})}}"), &[0; 8])
    };
    assert_eq!(NpyArray::parse(&of(32)).unwrap().shape, vec![1; 32]);
    assert!(NpyArray::parse(&of(33)).unwrap_err().to_string().contains("at most 32 axes"));
}
