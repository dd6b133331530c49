//! The answer to a request.

use axum::http::header::{
    ALLOW, CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, HeaderValue,
    REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::request::Parts;
use axum::http::{Response, StatusCode};
use kavics_viewer::{Content, PageError, PageFolder, Piece, bundle};

use crate::request::{check, columns};

pub(crate) type Body = axum::body::Body;

/// Scripts, styles and data of this server and of no other; no script or style within the page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
    img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const TEXT: &str = "text/plain; charset=utf-8";
const JSON: &str = "application/json";
const ARROW: &str = "application/vnd.apache.arrow.stream";

/// Other pages may not take what is served as if it were theirs.
const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// What the server at `port` says to a request.
pub(crate) fn answer(folder: &PageFolder, port: u16, head: &Parts) -> Response<Body> {
    if let Err((status, reason)) = check(head, port) {
        return refused(status, reason);
    }
    let path = head.uri.path();
    match path {
        "/" | "/index.html" => found("text/html; charset=utf-8", bundle::PAGE),
        "/viewer.js" => found("text/javascript; charset=utf-8", bundle::SCRIPT),
        "/viewer.css" => found("text/css; charset=utf-8", bundle::STYLE),
        _ => match path.strip_prefix("/data/").and_then(Piece::of_name) {
            Some(piece) => data(folder, piece, columns(head.uri.query()).as_deref()),
            None => refused(StatusCode::NOT_FOUND, format!("nothing is called {path}")),
        },
    }
}

/// The server itself is at fault.
pub(crate) fn broken() -> Response<Body> {
    refused(
        StatusCode::INTERNAL_SERVER_ERROR,
        "no answer was found".to_owned(),
    )
}

fn data(folder: &PageFolder, piece: Piece, columns: Option<&[String]>) -> Response<Body> {
    let columns: Option<Vec<&str>> =
        columns.map(|columns| columns.iter().map(String::as_str).collect());
    match folder.piece(piece, columns.as_deref()) {
        Ok(Content::Json(text)) => found(JSON, text),
        Ok(Content::Arrow(bytes)) => found(ARROW, bytes),
        Err(error) => refused(status(&error), error.to_string()),
    }
}

fn status(error: &PageError) -> StatusCode {
    if error.is_absence() {
        StatusCode::NOT_FOUND
    } else {
        StatusCode::INTERNAL_SERVER_ERROR
    }
}

fn found(kind: &'static str, body: impl Into<Body>) -> Response<Body> {
    with_headers(StatusCode::OK, kind, body.into())
}

fn refused(status: StatusCode, reason: String) -> Response<Body> {
    let mut response = with_headers(status, TEXT, (reason + "\n").into());
    if status == StatusCode::METHOD_NOT_ALLOWED {
        let allowed = HeaderValue::from_static("GET, HEAD");
        response.headers_mut().insert(ALLOW, allowed);
    }
    response
}

fn with_headers(status: StatusCode, kind: &'static str, body: Body) -> Response<Body> {
    let headers = [
        (CONTENT_TYPE, kind),
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (RESOURCE_POLICY, "same-origin"),
        // A run may be replaced by another at the same address.
        (CACHE_CONTROL, "no-store"),
    ];
    let mut response = Response::new(body);
    *response.status_mut() = status;
    for (name, value) in headers {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}
