//! Pieces of page data as scripts that do not run, and scripts and styles that stand in a page.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use sha2::{Digest, Sha256};

use crate::{Piece, bundle};

/// Little more is gained by more effort: the last bits of numbers are noise.
const EFFORT: u32 = 2;

/// An Arrow stream as an element of a page: compressed, in base64.
pub(crate) fn of_stream(piece: Piece, stream: &[u8]) -> String {
    format!(
        "<script type=\"application/vnd.apache.arrow.stream;base64\" data-name=\"{piece}\" data-encoding=\"deflate\">{}</script>\n",
        STANDARD.encode(compressed(stream))
    )
}

/// JSON as an element of a page.
pub(crate) fn of_json(piece: Piece, json: &str) -> String {
    // Within a string of JSON, where alone a < can stand, this is the same letter.
    let json = json.replace('<', "\\u003c");
    format!("<script type=\"application/json\" data-name=\"{piece}\">{json}</script>\n")
}

/// Bytes in the zlib format, the same for the same bytes.
pub(crate) fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(EFFORT));
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("memory takes all that is written")
}

/// The viewer's script as it stands in a page: nothing in it ends the element.
pub fn script() -> String {
    bundle::SCRIPT.replace("</script", "<\\/script")
}

/// The source expression by which a content security policy admits a script or style that stands in a page.
pub fn admitted(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)))
}

#[cfg(test)]
mod tests {
    use super::{admitted, of_json, script};
    use crate::{Piece, bundle};

    #[test]
    fn json_cannot_end_its_element() {
        let element = of_json(Piece::Run, "{\"title\":\"</script><b>\"}");
        assert_eq!(element.matches("</script").count(), 1);
        assert!(element.contains("\\u003c/script>\\u003cb>"), "{element}");
    }

    #[test]
    fn the_viewer_cannot_end_its_element() {
        assert!(!script().contains("</script"));
        assert!(!bundle::STYLE.contains("</style"));
    }

    #[test]
    fn a_hash_is_that_of_the_standard() {
        // NIST FIPS 180-4, examples: SHA-256 of "abc" is ba7816bf…f20015ad.
        let abc = "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='";
        assert_eq!(admitted("abc"), abc);
    }
}
