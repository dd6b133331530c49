//! What a request asks for, and whether it is one that is answered.

use std::collections::HashSet;

use axum::http::header::HOST;
use axum::http::request::Parts;
use axum::http::{Method, StatusCode};

/// Why a request is refused: a status and a sentence.
pub(crate) type Refusal = (StatusCode, String);

/// Refuses requests that are not sent to this server by name, and all that are no reading.
///
/// A page of somebody else may give its own name this address, and would then read what is served; its requests carry
/// that name as their host.
pub(crate) fn check(head: &Parts, port: u16) -> Result<(), Refusal> {
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let is_own = |host: &str| hosts.iter().any(|own| own.eq_ignore_ascii_case(host));
    let mut named = head.headers.get_all(HOST).iter();
    let host = named.next().and_then(|host| host.to_str().ok());
    let in_target = head
        .uri
        .authority()
        .is_none_or(|name| is_own(name.as_str()));
    if !(host.is_some_and(is_own) && named.next().is_none() && in_target) {
        let reason = format!("this server answers at {} only", hosts[0]);
        return Err((StatusCode::FORBIDDEN, reason));
    }
    if head.method != Method::GET && head.method != Method::HEAD {
        return Err((
            StatusCode::METHOD_NOT_ALLOWED,
            "this server is read only".to_owned(),
        ));
    }
    Ok(())
}

/// The columns that a query asks for, each once: `columns=a,b`; none where it names none.
pub(crate) fn columns(query: Option<&str>) -> Option<Vec<String>> {
    let wanted = query?
        .split('&')
        .find_map(|part| part.strip_prefix("columns="))?;
    // Names of columns are plain; a comma may be escaped.
    let wanted = wanted.replace("%2C", ",").replace("%2c", ",");
    let mut known = HashSet::new();
    let names = wanted.split(',');
    let names = names.filter(|name| !name.is_empty() && known.insert(*name));
    Some(names.map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::columns;

    #[test]
    fn columns_are_separated_by_commas_escaped_or_not() {
        let three = Some(vec!["x".to_owned(), "y".to_owned(), "ux".to_owned()]);
        assert_eq!(columns(Some("columns=x,y,ux")), three);
        assert_eq!(columns(Some("change=4&columns=x%2Cy%2cux")), three);
        assert_eq!(columns(Some("columns=x,y,x,ux,y,x")), three);
        assert_eq!(columns(Some("change=4")), None);
        assert_eq!(columns(None), None);
    }
}
