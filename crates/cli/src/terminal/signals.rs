//! Signals of the operating system.

/// From now on, calls `handle` on a separate thread for each signal that asks the process to end: SIGINT, SIGTERM and
/// SIGHUP. Signals that were ignored when the process began stay ignored, as with `nohup`.
///
/// If no handler can be installed, the signals end the process as usual.
#[cfg(unix)]
pub(super) fn on_each(handle: impl Fn() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    let ignored = ignored();
    let wanted = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let wanted = wanted.filter(|signal| ignored >> (signal - 1) & 1 == 0);
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) {
        // Where no thread can be had, the handlers stay without an effect; what is written is complete all the same.
        let _ = std::thread::Builder::new().spawn(move || {
            for _ in signals.forever() {
                handle();
            }
        });
    }
}

/// The same on systems whose only signal is Ctrl-C.
#[cfg(not(unix))]
pub(super) fn on_each(handle: impl Fn() + Send + 'static) {
    let _ = ctrlc::set_handler(handle);
}

/// From now on, calls `before` on a separate thread when the terminal asks the process to stop (Ctrl-Z), and `after` when
/// it continues.
#[cfg(unix)]
pub(super) fn on_stop(before: fn(), after: fn()) {
    use signal_hook::{consts::SIGTSTP, low_level};

    if ignored() >> (SIGTSTP - 1) & 1 != 0 {
        return;
    }
    if let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGTSTP]) {
        let _ = std::thread::Builder::new().spawn(move || {
            for _ in signals.forever() {
                before();
                // Which returns when the process continues.
                let _ = low_level::emulate_default_handler(SIGTSTP);
                after();
            }
        });
    }
}

/// Other systems do not stop processes.
#[cfg(not(unix))]
pub(super) fn on_stop(_before: fn(), _after: fn()) {}

/// Makes writing beyond the file size limit fail, instead of ending the process.
pub(crate) fn outlive_file_limits() {
    #[cfg(unix)]
    {
        let exceeded = std::sync::Arc::default();
        // Without a handler the process ends there as it always did.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, exceeded);
    }
}

/// Calls `handle` on the thread that aborts the process. The process then ends with the returned code.
///
/// `handle` must neither wait for long nor allocate memory.
#[cfg(unix)]
pub(super) fn on_abort(handle: impl Fn() -> i32 + Send + Sync + 'static) {
    use signal_hook::{consts::SIGABRT, low_level};

    let end = move || low_level::exit(handle());
    // SAFETY: a thread that aborts sends itself this signal, and not from inside of the allocator. Where another
    // process sends it, it may come anywhere; but the handler asks for no memory, takes locks that are held for moments,
    // and does not return.
    #[expect(
        unsafe_code,
        reason = "handlers of signals are bound by rules that the compiler does not know"
    )]
    let registered = unsafe { low_level::register(SIGABRT, end) };
    // Without a handler the process ends there as it always did.
    let _ = registered;
}

/// Other systems send no such signal.
#[cfg(not(unix))]
pub(super) fn on_abort(_handle: impl Fn() -> i32 + Send + Sync + 'static) {}

/// Writes to stderr without a lock.
#[cfg(unix)]
pub(super) fn say(text: &[u8]) {
    let _ = rustix::io::write(std::io::stderr(), text);
}

#[cfg(not(unix))]
pub(super) fn say(_text: &[u8]) {}

/// The ignored signals as bits, with signal 1 as the lowest bit; none if the system does not report them.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut lines = status.lines();
    let bits = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    bits.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok())
        .unwrap_or(0)
}
