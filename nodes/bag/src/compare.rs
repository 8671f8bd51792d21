use crate::tick_to_msg;
use servo::TickRecord;

/// Where a rendered tick differs from a recorded one, bit for bit; the measured times are left out.
/// `None` if it is the same. Fields are called as in `TickRecord.msg`.
#[must_use]
pub fn first_difference(recorded: &TickRecord, rendered: &TickRecord) -> Option<&'static str> {
    let (a, b) = (tick_to_msg(recorded), tick_to_msg(rendered));
    macro_rules! compare {
        ($($field:ident),*) => {
            $(if !same(&a.$field, &b.$field) { return Some(stringify!($field)); })*
        };
    }
    compare!(
        sequence,
        stamp,
        dt,
        sample,
        gains,
        enabled,
        reset_count,
        outside,
        remote,
        pose,
        twist,
        proxy_pose,
        depth,
        kind,
        contacts,
        law_wrench,
        out_wrench,
        energy,
        health
    );
    None
}

/// Equal as bytes: NaN is equal to itself and -0 differs from 0.
fn same<T: serde::Serialize>(a: &T, b: &T) -> bool {
    let bytes = |v: &T| cdr_encoding::to_vec::<T, byteorder::LittleEndian>(v).ok();
    bytes(a) == bytes(b)
}
