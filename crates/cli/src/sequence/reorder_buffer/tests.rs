use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use super::*;

fn piece(number: u64) -> Piece {
    Piece::Samples(vec![number as u8])
}

fn bytes(piece: Option<Piece>) -> Option<Vec<u8>> {
    match piece? {
        Piece::Samples(bytes) => Some(bytes),
        Piece::Block(_) => None,
    }
}

fn put(buffer: &ReorderBuffer, number: u64) {
    buffer.admit(number).unwrap().put(piece(number));
}

#[test]
fn pieces_come_in_order_and_never_too_many() {
    const MOST: u64 = 3;
    let buffer = ReorderBuffer::new(MOST);
    // Whoever fails closes the buffer, so that the test ends.
    thread::scope(|scope| {
        for remainder in 0..MOST {
            let buffer = &buffer;
            // Each of them is late for another reason, and none may wait for ever.
            scope.spawn(move || {
                for number in (remainder..300).step_by(MOST as usize) {
                    let slot = buffer.admit(number).unwrap();
                    assert!(buffer.lock().waiting.len() < MOST as usize);
                    slot.put(piece(number));
                }
            });
        }
        let closing = buffer.closing();
        for number in 0..300_u64 {
            assert_eq!(bytes(buffer.take()).unwrap(), [number as u8]);
        }
        std::mem::forget(closing);
    });
    assert!(buffer.admit(300).is_some());
}

#[test]
fn pieces_that_nobody_wants_make_room() {
    /// Far longer than it should take.
    const PATIENCE: Duration = Duration::from_secs(60);
    let buffer = ReorderBuffer::new(3);
    put(&buffer, 0);
    let late = buffer.admit(1).unwrap();
    let never = buffer.admit(2).unwrap();
    thread::scope(|scope| {
        let (sender, admitted) = channel();
        let buffer = &buffer;
        scope.spawn(move || {
            sender.send(()).unwrap();
            if let Some(slot) = buffer.admit(7) {
                slot.put(piece(7));
                sender.send(()).unwrap();
            }
        });
        // It has begun, and waits soon.
        admitted.recv().unwrap();
        thread::sleep(Duration::from_millis(50));
        buffer.skip_to(5);
        let admitted = admitted.recv_timeout(PATIENCE);
        if admitted.is_err() {
            // So that the test ends.
            buffer.close();
        }
        admitted.unwrap();
    });
    // What is unwanted does no harm, whether it comes or not.
    late.put(piece(1));
    assert!(!buffer.lock().waiting.contains_key(&1));
    drop(never);
    assert!(buffer.admit(4).is_none());
    put(&buffer, 5);
    put(&buffer, 6);
    buffer.skip_to(2);
    assert_eq!(buffer.lock().taken, 5);
    for number in 5..=7 {
        assert_eq!(bytes(buffer.take()), Some(vec![number]));
    }
    assert!(!buffer.is_closed());
}

#[test]
fn a_closed_buffer_gives_what_it_has_and_admits_nothing() {
    let buffer = ReorderBuffer::new(2);
    put(&buffer, 0);
    let second = buffer.admit(1).unwrap();
    thread::scope(|scope| {
        let waiting = scope.spawn(|| buffer.admit(7).is_none());
        let closing = buffer.closing();
        drop(second);
        assert!(buffer.is_closed());
        std::mem::forget(closing);
        assert!(waiting.join().unwrap());
    });
    assert_eq!(bytes(buffer.take()), Some(vec![0]));
    assert_eq!(bytes(buffer.take()), None);
    assert!(buffer.admit(1).is_none());
}
