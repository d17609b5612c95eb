//! Whatever comes, it does not panic, and what is asked after it is answered.

use proptest::collection::vec;
use proptest::prelude::*;

use crate::fake::{Fake, UNIT, Unit, framed};
use crate::seeded::seeded;

/// Bytes, and frames with a right checksum round any content.
fn pieces() -> impl Strategy<Value = Vec<u8>> {
    let functions = prop_oneof![any::<u8>(), 1_u8..=6, 15_u8..=16];
    let content = (functions, vec(any::<u8>(), 0..260));
    let small = (1_u8..=16, any::<bool>(), 0_u16..5010, 0_u16..130);
    prop_oneof![
        vec(any::<u8>(), 0..600),
        (any::<bool>(), content).prop_map(|(ours, (function, data))| {
            let unit = if ours { UNIT } else { 3 };
            framed(unit, &[&[function][..], &data].concat())
        }),
        small.prop_map(|(function, bulk, address, count)| {
            let mut content = crate::fake::asking(function, address, count);
            if bulk {
                content.push((count as u8).wrapping_mul(2));
                content.extend(std::iter::repeat_n(0x40, usize::from(count % 124) * 2));
            }
            framed(UNIT, &content)
        }),
    ]
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn any_bytes_leave_it_whole(pieces in vec((pieces(), 0_u32..5000), 0..6), on in any::<bool>()) {
        let mut panel = Fake::default();
        panel.view.seen.enabled = on;
        let before = panel.settings;
        let mut unit = Unit::of(panel);
        for (piece, pause) in &pieces {
            let mut sent = unit.hear(piece);
            sent.extend(unit.wait_us(*pause));
            for frame in sent {
                prop_assert!((5..=256).contains(&frame.len()) && frame[0] == UNIT);
            }
        }
        unit.wait_us(10_000);
        prop_assert_eq!(unit.read(4, 0, 1), [1]);
        prop_assert!(unit.panel.settings.validate().is_ok());
        if on {
            prop_assert!(unit.panel.settings == before && unit.panel.saved == 0);
        }
    }
}
