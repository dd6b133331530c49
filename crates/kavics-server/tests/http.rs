//! The server over a socket: what it answers, and what it refuses.

#[path = "../../kavics-results/tests/block/mod.rs"]
mod block;

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::thread;

use kavics_server::Server;

/// A server of its own, which goes with the process of the test.
struct Served {
    port: u16,
    place: tempfile::TempDir,
}

struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Served {
    /// Results in a folder of a folder, so that there is something above them.
    fn new() -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        fs::write(place.path().join("secret.txt"), "secret").expect("room on the disk");
        let folder = place.path().join("block.results");
        block::write(&folder, &block::scene(7, 5));
        let server = Server::bind(&folder, 0).expect("a free port");
        let address = server.address();
        let port = address.trim_end_matches('/').rsplit(':').next();
        let port = port.and_then(|port| port.parse().ok()).expect("a port");
        thread::spawn(|| server.run(|| Ok(())));
        Self { port, place }
    }

    fn folder(&self) -> std::path::PathBuf {
        self.place.path().join("block.results")
    }

    /// What is answered to these bytes.
    fn send(&self, request: &str) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.write_all(request.as_bytes()).expect("a request");
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("an answer");
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
        let body = bytes.split_off(end.expect("a head") + 4);
        let head = String::from_utf8(bytes).expect("a head of text");
        let status = head.split(' ').nth(1).and_then(|word| word.parse().ok());
        Answer {
            status: status.expect("a status"),
            head: head.to_lowercase(),
            body,
        }
    }

    fn ask(&self, method: &str, target: &str, host: &str) -> Answer {
        self.send(&format!(
            "{method} {target} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        ))
    }

    fn get(&self, target: &str) -> Answer {
        self.ask("GET", target, &format!("127.0.0.1:{}", self.port))
    }
}

impl Answer {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

#[test]
fn the_page_and_its_files_are_served() {
    let served = Served::new();
    for (target, kind) in [
        ("/", "text/html"),
        ("/viewer.js", "text/javascript"),
        ("/viewer.css", "text/css"),
    ] {
        let answer = served.get(target);
        assert_eq!(answer.status, 200, "{target}");
        let head = format!("content-type: {kind}");
        assert!(answer.head.contains(&head), "{}", answer.head);
        assert!(!answer.body.is_empty());
    }
}

#[test]
fn every_answer_forbids_foreign_scripts_and_guessing() {
    let served = Served::new();
    for target in ["/", "/data/run.json", "/data/grains/0", "/nothing"] {
        let head = served.get(target).head;
        assert!(
            head.contains("content-security-policy: default-src 'none'"),
            "{head}"
        );
        assert!(head.contains("x-content-type-options: nosniff"), "{head}");
        assert!(
            head.contains("cross-origin-resource-policy: same-origin"),
            "{head}"
        );
        assert!(!head.contains("access-control"), "{head}");
    }
}

#[test]
fn tables_come_as_streams_and_the_record_as_json() {
    let served = Served::new();
    let record = served.get("/data/run.json");
    assert!(record.head.contains("content-type: application/json"));
    let text = record.text();
    assert!(
        text.contains("\"grains\":32") && text.contains("\"embedded\":false"),
        "{text}"
    );
    let table = served.get("/data/grains/1?columns=x,y,radius");
    assert_eq!(table.status, 200);
    // The mark with which an Arrow message begins.
    assert_eq!(table.body[..4], [0xff; 4]);
    let whole = served.get("/data/grains/1");
    assert!(whole.body.len() > table.body.len());
}

#[test]
fn a_head_has_no_body() {
    let served = Served::new();
    let host = format!("localhost:{}", served.port);
    let answer = served.ask("HEAD", "/data/run.json", &host);
    assert_eq!((answer.status, answer.body.len()), (200, 0));
}

#[test]
fn nothing_is_written() {
    let served = Served::new();
    let host = format!("127.0.0.1:{}", served.port);
    for method in ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"] {
        let answer = served.ask(method, "/data/run.json", &host);
        assert_eq!(answer.status, 405, "{method}");
        assert!(answer.head.contains("allow: get, head"), "{}", answer.head);
    }
}

#[test]
fn only_this_server_is_meant() {
    let served = Served::new();
    let port = served.port;
    for host in [
        "example.org".to_owned(),
        format!("example.org:{port}"),
        "127.0.0.1".to_owned(),
        format!("127.0.0.1:{}", port ^ 1),
        format!("127.0.0.1.example.org:{port}"),
        format!("user@127.0.0.1:{port}"),
        String::new(),
    ] {
        let answer = served.ask("GET", "/data/run.json", &host);
        assert!(
            [400, 403].contains(&answer.status),
            "{host}: {}",
            answer.status
        );
        assert!(!answer.text().contains("grains"), "{host}");
    }
    let without = served.send("GET /data/run.json HTTP/1.0\r\n\r\n");
    assert_eq!(without.status, 403);
    let two = format!("127.0.0.1:{port}\r\nHost: example.org");
    assert!([400, 403].contains(&served.ask("GET", "/data/run.json", &two).status));
    let own = format!("127.0.0.1:{port}");
    let elsewhere = format!("http://example.org:{port}/data/run.json");
    assert_eq!(served.ask("GET", &elsewhere, &own).status, 403);
}

#[test]
fn no_way_leads_out_of_the_results() {
    let served = Served::new();
    let secret = served.place.path().join("secret.txt");
    let absolute = secret.display().to_string();
    for target in [
        "/../secret.txt",
        "/data/../secret.txt",
        "/data/../../secret.txt",
        "/data/..%2f..%2fsecret.txt",
        "/data/%2e%2e/%2e%2e/secret.txt",
        "/data/%252e%252e/secret.txt",
        "/data/..\\..\\secret.txt",
        "/data/grains/../../../secret.txt",
        "/data/grains/..%2f..%2f..%2fsecret.txt",
        "/data/grains/0%00",
        "/data//etc/passwd",
        "/data/scene.toml",
        "/scene.toml",
        "/run.json",
        "/data/log.ndjson",
        "//secret.txt",
        &format!("/data/{absolute}"),
        &format!("/data/{}", absolute.replace('/', "%2f")),
        &absolute,
    ] {
        let answer = served.get(target);
        assert!(
            [400, 404].contains(&answer.status),
            "{target}: {}",
            answer.status
        );
        assert!(answer.text() != "secret", "{target}");
    }
}

#[cfg(unix)]
#[test]
fn links_that_lead_out_of_the_results_are_not_followed() {
    let served = Served::new();
    let stranger = served.place.path().join("stranger.results");
    block::write(&stranger, &block::scene(5, 5));
    let lead_out = |name: &str| {
        let link = served.folder().join(name);
        fs::remove_file(&link).expect("a file of the run");
        std::os::unix::fs::symlink(stranger.join(name), link).expect("a link");
    };
    let is_refused = |target: &str| {
        let answer = served.get(target);
        assert_eq!(answer.status, 404, "{target}: {}", answer.text());
        assert!(answer.text().contains("leads out of"), "{}", answer.text());
    };
    lead_out("grains/000001.parquet");
    is_refused("/data/grains/1");
    is_refused("/data/row/grains/1/0");
    is_refused("/data/crosses/1");
    lead_out("steps.parquet");
    is_refused("/data/steps");
    lead_out("events.parquet");
    is_refused("/data/contacts/1?columns=broke_at");
    lead_out("scene.toml");
    is_refused("/data/run.json");
    lead_out("run.json");
    is_refused("/data/run.json");
    assert!(Path::new(&stranger).join("run.json").is_file());
}

#[test]
fn a_recorded_table_that_is_missing_is_told() {
    let served = Served::new();
    let lost = "sides/000005.parquet";
    fs::remove_file(served.folder().join(lost)).expect("a file of the run");
    let record = served.get("/data/run.json");
    assert_eq!(record.status, 500);
    let text = record.text();
    assert!(text.contains(&format!("{lost} is missing")), "{text}");
    let answer = served.get("/data/sides/5");
    assert_eq!(answer.status, 404);
    assert_eq!(
        answer.text(),
        "there is no whole table \"sides\" of load step 5\n"
    );
    let refused = Server::bind(&served.folder(), 0).expect_err("a refusal");
    assert!(refused.to_string().contains(lost), "{refused}");
}

#[test]
fn what_is_not_there_is_named() {
    let served = Served::new();
    for (target, sentence) in [
        (
            "/data/grains/99",
            "there is no whole table \"grains\" of load step 99\n",
        ),
        (
            "/data/grains/1?columns=x,colour",
            "the table \"grains\" has no column called \"colour\"\n",
        ),
        (
            "/data/row/grains/1/32",
            "the table \"grains\" of load step 1 has no row 32\n",
        ),
        ("/data/everything", "nothing is called /data/everything\n"),
    ] {
        let answer = served.get(target);
        assert_eq!((answer.status, answer.text()), (404, sentence.to_owned()));
    }
}

#[test]
fn what_is_broken_is_no_absence() {
    let served = Served::new();
    fs::write(served.folder().join("grains/000001.parquet"), "no Parquet").expect("room");
    assert_eq!(served.get("/data/grains/1").status, 500);
    // Others are still served.
    assert_eq!(served.get("/data/grains/2").status, 200);
}

#[test]
fn a_port_that_is_taken_is_named() {
    let served = Served::new();
    let error = Server::bind(&served.folder(), served.port).expect_err("a port that is taken");
    assert!(
        error
            .to_string()
            .starts_with(&format!("127.0.0.1:{}: ", served.port)),
        "{error}"
    );
}
