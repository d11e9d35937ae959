use super::*;
use crate::base::size::Size;
use crate::formats::picture::tests::Whole;

fn decode(bytes: &[u8]) -> Result<Picture, String> {
    begin(&Source::Memory(bytes.into()))
}

fn whole(bytes: &[u8]) -> Whole {
    decode(bytes).unwrap().whole().unwrap()
}

fn file(array: &Array, numbers: &[u8]) -> Vec<u8> {
    [&header::bytes(array, None), numbers].concat()
}

fn array(channels: Option<u32>, number: Number) -> Array {
    Array {
        size: Size {
            width: 2,
            height: 1,
        },
        channels,
        number,
    }
}

fn doubles(numbers: &[f64]) -> Vec<u8> {
    numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect()
}

#[test]
fn channels_are_read_by_their_number() {
    let numbers = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8];
    for (channels, description, second) in [
        (None, "NPY, double, Y", [0.2, 0.2, 0.2, 1.0]),
        (Some(1), "NPY, double, Y", [0.2, 0.2, 0.2, 1.0]),
        (Some(2), "NPY, double, YA", [0.3, 0.3, 0.3, 0.4]),
        (Some(3), "NPY, double, RGB", [0.4, 0.5, 0.6, 1.0]),
        (Some(4), "NPY, double, RGBA", [0.5, 0.6, 0.7, 0.8]),
    ] {
        let count = 2 * channels.unwrap_or(1) as usize;
        let file = file(&array(channels, Number::F64), &doubles(&numbers[..count]));
        let picture = decode(&file).unwrap();
        assert_eq!(picture.description, description);
        let whole = picture.whole().unwrap();
        assert_eq!(whole.rgba[0][1], second);
        assert_eq!(whole.rounding[0][1], [0.0; 4]);
        assert_eq!(whole.is_full[0][1], [false; 4]);
    }
}

#[test]
fn floats_and_whole_numbers_are_read() {
    let floats: Vec<u8> = [0.25_f32, f32::MAX]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    let picture = whole(&file(&array(None, Number::F32), &floats));
    assert_eq!(picture.rgba[0][0][0], 0.25);
    // A float has 24 bits.
    assert_eq!(picture.rounding[0][0][0], 0.25 * 2_f64.powi(-24));
    assert!(picture.is_full[0][1][0]);
    let whole: Vec<u8> = [7_u32, u32::MAX]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    let picture = self::whole(&file(&array(None, Number::U32), &whole));
    assert_eq!(picture.rgba[0][0][0], 7.0);
    assert_eq!(picture.rgba[0][1][0], 4_294_967_295.0);
}

#[test]
fn what_is_no_picture_is_refused() {
    let whole = file(&array(None, Number::F64), &doubles(&[0.1, 0.2]));
    let longer = [&whole[..], b"\0"].concat();
    for (bytes, reason) in [
        (&whole[..whole.len() - 1], "more or fewer"),
        (&longer, "more or fewer"),
        (&whole[..20], "cut off"),
        (&file(&array(Some(5), Number::F64), &[0; 80]), "found 5"),
        (&file(&array(Some(0), Number::F64), &[]), "found 0"),
    ] {
        let refused = decode(bytes).err().unwrap();
        assert!(refused.contains(reason), "{refused}");
    }
    let empty = Array {
        size: Size {
            width: 0,
            height: 1,
        },
        channels: None,
        number: Number::F64,
    };
    assert!(decode(&file(&empty, &[])).is_err());
}
