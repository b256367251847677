//! Which pages may connect. A browser lets any page open a socket to this machine, and says which page it is.

use crate::error::LiveError;

/// Viewers that run as pages of their makers, and desktop viewers, whose pages are files.
const VIEWERS: [&str; 3] = ["https://app.foxglove.dev", "https://studio.foxglove.dev", "file://"];

/// Origins of pages that are let in. A browser says which page asks; what says none is no page, and runs on this
/// machine already.
#[derive(Debug, Clone, Default)]
pub struct Origins {
    named: Vec<String>,
    any: bool,
}

impl Origins {
    /// Pages of this machine's own servers, and those named: `https://host`, with a port where it is not the usual
    /// one, or `null`, which pages from files have, and frames that any page makes as well.
    ///
    /// # Errors
    /// [`LiveError::Origin`] for what no browser sends as an origin.
    pub fn new(named: &[String]) -> Result<Self, LiveError> {
        let named = named
            .iter()
            .map(|given| {
                let (scheme, host) = given.split_once("://").unwrap_or((given, ""));
                let known = given == "null"
                    || (!scheme.is_empty() && !host.is_empty() && !host.contains(['/', '?', '#', ' ']));
                known.then(|| given.to_ascii_lowercase()).ok_or_else(|| LiveError::Origin {
                    expected: "scheme and host without a path, such as https://example.org, or null",
                    given: given.clone(),
                })
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { named, any: false })
    }

    /// Pages of this machine's own servers, known viewers, and one origin more, or all for `*`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_viewers(further: Option<&str>) -> Result<Self, LiveError> {
        let any = further == Some("*");
        let further = further.filter(|_| !any).map(|one| one.trim_end_matches('/').to_owned());
        let Self { mut named, .. } = Self::new(further.as_slice())?;
        named.extend(VIEWERS.map(String::from));
        Ok(Self { named, any })
    }

    /// Whether a page of this origin is let in; `None` for a client that is no page.
    pub fn allow(&self, origin: Option<&str>) -> bool {
        let Some(origin) = origin else { return true };
        let origin = origin.to_ascii_lowercase();
        let host = origin.strip_prefix("http://").or_else(|| origin.strip_prefix("https://"));
        self.any || host.is_some_and(is_local) || self.named.contains(&origin)
    }
}

/// Whether a host, with or without a port, is this machine.
fn is_local(host: &str) -> bool {
    ["localhost", "127.0.0.1", "[::1]"].iter().any(|name| {
        host.strip_prefix(name).is_some_and(|port| {
            port.is_empty()
                || port.strip_prefix(':').is_some_and(|digits| digits.parse::<u16>().is_ok())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_of_this_machine_and_those_named_are_let_in() {
        let named = ["https://Radar.example:8443".into(), "null".into()];
        for (origin, plain, with_names) in [
            (None, true, true),
            (Some("http://localhost"), true, true),
            (Some("http://localhost:4173"), true, true),
            (Some("https://127.0.0.1:1"), true, true),
            (Some("http://[::1]:8080"), true, true),
            (Some("http://localhost.evil.example"), false, false),
            (Some("http://localhost:80@evil.example"), false, false),
            (Some("http://127.0.0.1.evil.example"), false, false),
            (Some("http://evil.example/localhost"), false, false),
            (Some("https://radar.example"), false, false),
            (Some("https://radar.example:8443"), false, true),
            (Some("http://radar.example:8443"), false, false),
            (Some("null"), false, true),
            (Some(""), false, false),
            (Some("file://localhost"), false, false),
        ] {
            assert_eq!(Origins::default().allow(origin), plain, "{origin:?}");
            assert_eq!(Origins::new(&named).unwrap().allow(origin), with_names, "{origin:?}");
        }
    }

    #[test]
    fn known_viewers_and_one_origin_more_are_let_in() {
        let allows = |further, origin| Origins::of_viewers(further).unwrap().allow(Some(origin));
        for origin in ["https://app.foxglove.dev", "file://", "http://localhost:5173"] {
            assert!(allows(None, origin), "{origin}");
        }
        for origin in ["null", "", "https://app.foxglove.dev.example.com", "ftp://localhost"] {
            assert!(!allows(None, origin), "{origin}");
            assert!(allows(Some("*"), origin), "{origin}");
        }
        assert!(allows(Some("https://viewer.example.com/"), "https://viewer.example.com"));
        assert!(!allows(Some("https://example.com"), "https://viewer.example.com"));
        assert!(Origins::of_viewers(Some("example.com")).is_err());
    }

    #[test]
    fn what_is_no_origin_is_refused() {
        for given in ["", "example.org", "https://", "https://example.org/page", "*", "://x"] {
            let error = Origins::new(&[given.into()]).unwrap_err();
            assert!(matches!(error, LiveError::Origin { .. }), "{given}: {error}");
        }
    }
}
