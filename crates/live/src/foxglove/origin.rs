//! Which pages may connect. A browser lets any page open a socket to this machine, and says which page it is.

/// Viewers that run as pages of their makers, and desktop viewers, whose pages are files.
const VIEWERS: [&str; 3] = ["https://app.foxglove.dev", "https://studio.foxglove.dev", "file://"];
/// Names of this machine.
const LOCAL: [&str; 3] = ["localhost", "127.0.0.1", "[::1]"];

/// Whether a page of an origin may connect. Programs that are no browsers send none. `further` is one more origin, or `*` for
/// all of them.
#[must_use]
pub fn is_allowed(origin: Option<&str>, further: Option<&str>) -> bool {
    let Some(origin) = origin else { return true };
    let same = |other: &str| other.trim_end_matches('/').eq_ignore_ascii_case(origin);
    let is_viewer = VIEWERS.iter().any(|viewer| viewer.eq_ignore_ascii_case(origin));
    is_viewer || is_local(origin) || further.is_some_and(|one| one == "*" || same(one))
}

fn is_local(origin: &str) -> bool {
    let host = ["http://", "https://"].iter().find_map(|scheme| origin.strip_prefix(scheme));
    host.is_some_and(|host| {
        LOCAL.iter().any(|name| {
            let rest = host.strip_prefix(name);
            let port =
                rest.and_then(|rest| rest.strip_prefix(':').or(rest.is_empty().then_some("0")));
            port.is_some_and(|port| port.parse::<u16>().is_ok())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::is_allowed;

    #[test]
    fn pages_of_this_machine_and_known_viewers_connect_and_no_others() {
        for origin in [
            "http://localhost",
            "http://localhost:5173",
            "https://127.0.0.1:8080",
            "http://[::1]:1",
            "https://app.foxglove.dev",
            "file://",
        ] {
            assert!(is_allowed(Some(origin), None), "{origin}");
        }
        for origin in [
            "null",
            "",
            "https://example.com",
            "http://localhost.example.com",
            "http://localhost:80@example.com",
            "http://localhost:99999",
            "http://127.0.0.1.example.com:8765",
            "ftp://localhost",
            "https://app.foxglove.dev.example.com",
        ] {
            assert!(!is_allowed(Some(origin), None), "{origin}");
            assert!(is_allowed(Some(origin), Some("*")), "{origin}");
        }
        assert!(is_allowed(None, None));
        assert!(is_allowed(
            Some("https://viewer.example.com"),
            Some("https://viewer.example.com/")
        ));
        assert!(!is_allowed(Some("https://viewer.example.com"), Some("https://example.com")));
    }
}
