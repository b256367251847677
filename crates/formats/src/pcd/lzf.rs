//! LZF, as the Point Cloud Library packs columns: literal runs, and copies of what came before.
//!
//! A control byte below 32 is followed by that many bytes and one more, taken as they are. Otherwise its upper three bits are
//! the length of a copy less two (7 means that the next byte is added), its lower five and the following byte the distance
//! back, less one.

/// A copy of up to 264 bytes takes three.
const MOST_GROWTH: usize = 88;

/// Unpacks to exactly `length` bytes; the error says what is wrong with the packed ones, and where.
pub(super) fn unpack(packed: &[u8], length: usize) -> Result<Vec<u8>, (usize, &'static str)> {
    if length > packed.len().saturating_mul(MOST_GROWTH) {
        return Err((0, "a length that so few bytes cannot unpack to"));
    }
    let mut out = Vec::with_capacity(length);
    let mut at = 0;
    let cut = |at: usize| (at, "an end within a run");
    while at < packed.len() {
        let control = usize::from(packed[at]);
        at += 1;
        if control < 32 {
            let run = packed.get(at..at + control + 1).ok_or(cut(at))?;
            out.extend_from_slice(run);
            at += control + 1;
        } else {
            let mut count = control >> 5;
            if count == 7 {
                count += usize::from(*packed.get(at).ok_or(cut(at))?);
                at += 1;
            }
            let low = usize::from(*packed.get(at).ok_or(cut(at))?);
            at += 1;
            let distance = ((control & 0x1f) << 8) + low + 1;
            let from =
                out.len().checked_sub(distance).ok_or((at, "a copy from before the beginning"))?;
            // A copy may reach into itself.
            for i in from..from + count + 2 {
                out.push(out[i]);
            }
        }
        if out.len() > length {
            return Err((at, "more bytes than announced"));
        }
    }
    if out.len() == length { Ok(out) } else { Err((at, "fewer bytes than announced")) }
}
