/// One input report, decoded. Axes are raw counts: right, backward, down; full scale is about 350.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Report {
    /// Report 1 of the split format.
    Translation([i16; 3]),
    /// Report 2 of the split format.
    Rotation([i16; 3]),
    /// Report 1 of the combined format: translation, then rotation.
    Motion([i16; 6]),
    /// Report 3: bit 0 is the first button.
    Buttons(u32),
    /// A report that says nothing about the hand, such as the battery's.
    Other(u8),
}

/// A report that cannot be one of a SpaceMouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("HID report {id} has {length} bytes, which is no report of a SpaceMouse")]
pub struct Garbage {
    /// The first byte; 0 if there is none.
    pub id: u8,
    /// All bytes, the first included.
    pub length: usize,
}

impl Report {
    /// The longest report that is looked at; the rest of a longer one is padding.
    pub const MAX_LENGTH: usize = 64;

    /// Decodes a report that starts with its number. Which of the two formats it is shows in its length, not in the
    /// product number: the same product has had both.
    ///
    /// # Errors
    /// The report is empty, or too short for its number.
    pub fn decode(bytes: &[u8]) -> Result<Self, Garbage> {
        let garbage = Garbage { id: bytes.first().copied().unwrap_or(0), length: bytes.len() };
        let Some((&id, data)) = bytes.split_first() else { return Err(garbage) };
        match (id, data.len()) {
            (1, 12..) => Ok(Self::Motion(axes(data).ok_or(garbage)?)),
            (1, 6..) => Ok(Self::Translation(axes(data).ok_or(garbage)?)),
            (2, 6..) => Ok(Self::Rotation(axes(data).ok_or(garbage)?)),
            (3, 1..) => {
                let mut mask = [0; 4];
                let n = data.len().min(4);
                mask[..n].copy_from_slice(&data[..n]);
                Ok(Self::Buttons(u32::from_le_bytes(mask)))
            }
            (0..=3, _) => Err(garbage),
            _ => Ok(Self::Other(id)),
        }
    }
}

fn axes<const N: usize>(data: &[u8]) -> Option<[i16; N]> {
    let mut out = [0; N];
    for (axis, pair) in out.iter_mut().zip(data.get(..2 * N)?.chunks_exact(2)) {
        *axis = i16::from_le_bytes([pair[0], pair[1]]);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Reports in the layout of a SpaceNavigator (046d:c626), which splits them.
    const SPLIT: [(&[u8], Report); 5] = [
        (&[0x01, 0x5e, 0x01, 0x00, 0x00, 0x00, 0x00], Report::Translation([350, 0, 0])),
        (&[0x01, 0xf6, 0xff, 0xa2, 0xfe, 0x21, 0x00], Report::Translation([-10, -350, 33])),
        (&[0x02, 0x00, 0x00, 0x9c, 0xff, 0x64, 0x00], Report::Rotation([0, -100, 100])),
        (&[0x03, 0x01, 0x00], Report::Buttons(1)),
        (&[0x03, 0x00, 0x00], Report::Buttons(0)),
    ];

    /// Reports in the layout of a SpaceMouse Wireless or Compact (256f:c635), which combines them.
    const COMBINED: [(&[u8], Report); 4] = [
        (
            &[0x01, 0x5e, 0x01, 0xa2, 0xfe, 0x00, 0x00, 0x05, 0x00, 0xfb, 0xff, 0x00, 0x00],
            Report::Motion([350, -350, 0, 5, -5, 0]),
        ),
        (&[0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], Report::Motion([0; 6])),
        (&[0x03, 0x02, 0x00, 0x00, 0x80], Report::Buttons(0x8000_0002)),
        (&[0x17, 0x5b, 0x00], Report::Other(0x17)),
    ];

    #[test]
    fn both_formats_are_told_by_length() {
        for (bytes, report) in SPLIT.into_iter().chain(COMBINED) {
            assert_eq!(Report::decode(bytes), Ok(report), "{bytes:02x?}");
        }
    }

    #[test]
    fn padding_changes_nothing() {
        let mut padded = [0xaa; 64];
        padded[..13].copy_from_slice(COMBINED[0].0);
        assert_eq!(Report::decode(&padded), Ok(COMBINED[0].1));
    }

    #[test]
    fn short_reports_are_garbage() {
        let empty: &[u8] = &[];
        for bytes in [empty, &[1], &[1, 2, 3, 4, 5, 6], &[2, 0], &[3], &[0, 0, 0, 0, 0, 0, 0]] {
            let garbage = Report::decode(bytes).unwrap_err();
            assert_eq!(garbage.length, bytes.len());
        }
    }

    proptest! {
        #[test]
        fn any_bytes_decode_or_are_refused(bytes in proptest::collection::vec(any::<u8>(), 0..80)) {
            match Report::decode(&bytes) {
                Ok(Report::Translation(_)) => prop_assert!(bytes[0] == 1 && (7..13).contains(&bytes.len())),
                Ok(Report::Motion(_)) => prop_assert!(bytes[0] == 1 && bytes.len() >= 13),
                Ok(Report::Rotation(_)) => prop_assert!(bytes[0] == 2 && bytes.len() >= 7),
                Ok(Report::Buttons(_)) => prop_assert!(bytes[0] == 3 && bytes.len() >= 2),
                Ok(Report::Other(id)) => prop_assert!(id > 3),
                Err(garbage) => prop_assert_eq!(garbage.length, bytes.len()),
            }
        }

        #[test]
        fn axes_survive_the_way_through_bytes(axes in any::<[i16; 6]>()) {
            let mut bytes = vec![1];
            bytes.extend(axes.iter().flat_map(|a| a.to_le_bytes()));
            prop_assert_eq!(Report::decode(&bytes), Ok(Report::Motion(axes)));
            let split = [axes[0], axes[1], axes[2]];
            prop_assert_eq!(Report::decode(&bytes[..7]), Ok(Report::Translation(split)));
        }
    }
}
