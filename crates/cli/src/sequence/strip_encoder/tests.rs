//! Tests of `strip_encoder.rs`.

use std::sync::mpsc::channel;

use marbles_core::Channels;

use super::*;
use crate::base::region::Region;
use crate::base::size::Size;
use crate::formats::encoding::Encoding;
use crate::formats::form::Form;
use crate::formats::tests::PNG;

#[test]
fn a_strip_that_is_given_up_leaves_nobody_waiting() {
    let (width, height) = (3, 90);
    let form = Form {
        region: Region::all(Size { width, height }),
        channels: Channels::Grey,
        alpha: false,
        centers: None,
    };
    let encoder = Encoder::new(Encoding::Png(PNG), form, &[]);
    let buffer = ReorderBuffer::new(2);
    let (sender, finished) = channel();
    let clock = Clock::new(1);
    let picture = PictureEncoder::new(&encoder, &buffer, 0, &clock, sender);
    let open = OpenStrip::default();
    let sinks: Vec<LayerEncoder<'_, '_>> = picture.layers(&open).collect();
    let [sink] = &sinks[..] else {
        panic!("{} layers", sinks.len());
    };
    let [first, second] = [0, 1].map(|index| sink.begin(index).unwrap());
    second.end();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| sink.begin(2).is_none());
        let closing = buffer.closing();
        drop(first);
        assert!(buffer.is_closed());
        std::mem::forget(closing);
        assert!(waiting.join().unwrap());
    });
    assert!(buffer.take().is_none());
    assert!(finished.try_recv().is_err());
}
