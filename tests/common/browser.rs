//! A browser without a window, driven by the WebDriver protocol.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A page in a browser.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    /// `None` where there is no `chromedriver` with a browser.
    pub fn start() -> Option<Self> {
        let free = TcpListener::bind("127.0.0.1:0").ok()?;
        let port = free.local_addr().ok()?.port();
        drop(free);
        let mut command = Command::new("chromedriver");
        command.arg(format!("--port={port}"));
        let driver = command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut browser = Self {
            driver: driver.spawn().ok()?,
            port,
            session: String::new(),
        };
        let end = Instant::now() + Duration::from_secs(60);
        while browser.ask("GET", "/status", &Value::Null).is_none() {
            if Instant::now() > end {
                return None;
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--no-first-run",
            "--disable-sync",
            "--disable-background-networking",
            "--disable-component-update",
            "--force-device-scale-factor=1",
        ];
        let wanted = json!({ "capabilities": { "alwaysMatch": { "goog:chromeOptions": { "args": arguments } } } });
        let session = browser.ask("POST", "/session", &wanted)?;
        browser.session = session["sessionId"].as_str()?.to_owned();
        Some(browser)
    }

    /// Opens a file in a window of some size.
    pub fn open(&self, file: &Path, [width, height]: [u32; 2]) {
        self.post("/window/rect", &json!({ "width": width, "height": height }));
        self.post(
            "/url",
            &json!({ "url": format!("file://{}", file.display()) }),
        );
    }

    /// What a program in the page returns.
    pub fn run(&self, program: &str) -> Value {
        self.post("/execute/sync", &json!({ "script": program, "args": [] }))
    }

    /// Moves the pointer over an element to some pixels from its middle; with the button held from where it was where it drags.
    pub fn point(&self, element: &str, path: &[[i64; 2]], drags: bool) {
        let result = self.post(
            "/element",
            &json!({ "using": "css selector", "value": element }),
        );
        self.post(
            "/execute/sync",
            &json!({ "script": "arguments[0].scrollIntoView({block: 'center'})", "args": [result] }),
        );
        let moves = path.iter().map(|[x, y]| {
            json!({ "type": "pointerMove", "duration": 20, "x": x, "y": y, "origin": result })
        });
        let mut actions: Vec<Value> = moves.collect();
        if drags {
            actions.insert(1, json!({ "type": "pointerDown", "button": 0 }));
            actions.push(json!({ "type": "pointerUp", "button": 0 }));
        }
        let pointer = json!({ "type": "pointer", "id": "mouse", "parameters": { "pointerType": "mouse" }, "actions": actions });
        self.post("/actions", &json!({ "actions": [pointer] }));
    }

    /// The page as PNG, in base64.
    pub fn picture(&self) -> String {
        let path = format!("/session/{}/screenshot", self.session);
        self.ask("GET", &path, &Value::Null)
            .unwrap()
            .as_str()
            .unwrap()
            .to_owned()
    }

    fn post(&self, path: &str, body: &Value) -> Value {
        let path = format!("/session/{}{path}", self.session);
        let answer = self.ask("POST", &path, body).unwrap();
        assert!(answer["error"].is_null(), "{path}: {answer:#}");
        answer
    }

    fn ask(&self, method: &str, path: &str, body: &Value) -> Option<Value> {
        let body = if body.is_null() {
            String::new()
        } else {
            body.to_string()
        };
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).ok()?;
        stream
            .set_read_timeout(Some(Duration::from_secs(120)))
            .ok()?;
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nConnection: close\r\n\
             Content-Length: {}\r\n\r\n{body}",
            body.len()
        )
        .ok()?;
        let mut answer = Vec::new();
        let mut part = [0; 65536];
        let complete = loop {
            let count = stream.read(&mut part).ok()?;
            answer.extend(&part[..count]);
            if let Some(complete) = body_of(&answer).or((count == 0).then(Vec::new)) {
                break complete;
            }
        };
        let value: Value = serde_json::from_slice(&complete).ok()?;
        Some(value["value"].clone())
    }
}

/// The body of an answer that has come as a whole.
fn body_of(answer: &[u8]) -> Option<Vec<u8>> {
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n")? + 4;
    let head = String::from_utf8_lossy(&answer[..end]).to_lowercase();
    let length = head.split("content-length:").nth(1)?.lines().next()?;
    let length: usize = length.trim().parse().ok()?;
    answer.get(end..end + length).map(<[u8]>::to_vec)
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() {
            let path = format!("/session/{}", self.session);
            let _ = self.ask("DELETE", &path, &Value::Null);
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
