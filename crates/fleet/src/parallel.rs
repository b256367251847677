//! The same work on many pieces, over threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

/// Does `work` on each piece over so many threads, and hands what comes of it to `take`, in the order in which it comes.
///
/// # Errors
/// The first of `take`, after which no more pieces are begun.
pub fn each<P: Sync, R: Send, E>(
    pieces: &[P],
    threads: usize,
    work: impl Fn(&P) -> R + Sync,
    mut take: impl FnMut(R) -> Result<(), E>,
) -> Result<(), E> {
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let (sender, results) = mpsc::sync_channel(threads.max(1));
        for _ in 0..threads.clamp(1, pieces.len().max(1)) {
            let (sender, next, stop, work) = (sender.clone(), &next, &stop, &work);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let Some(piece) = pieces.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        break;
                    };
                    if sender.send(work(piece)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let ended = results.iter().try_for_each(&mut take);
        stop.store(true, Ordering::Relaxed);
        drop(results);
        ended
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_piece_is_done_once_and_an_error_ends_it() {
        let pieces: Vec<u32> = (0..1000).collect();
        for threads in [0, 1, 3, 2000] {
            let mut all = vec![];
            let ended: Result<(), ()> = each(
                &pieces,
                threads,
                |p| p * 2,
                |r| {
                    all.push(r);
                    Ok(())
                },
            );
            all.sort_unstable();
            assert_eq!(ended, Ok(()));
            assert!(all.iter().copied().eq((0..1000).map(|p| p * 2)));
            let mut taken = 0;
            let ended = each(
                &pieces,
                threads,
                |p| *p,
                |_| {
                    taken += 1;
                    if taken == 5 { Err(()) } else { Ok(()) }
                },
            );
            assert_eq!((ended, taken), (Err(()), 5));
        }
        assert_eq!(each(&[] as &[u32], 4, |_| (), |()| Err(())), Ok(()));
    }
}
