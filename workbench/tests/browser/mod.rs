//! Chromium without a display, told what to do over its own protocol, and a server for the page.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

mod server;

use server::serve;

/// How long something may take to come about.
const PATIENCE: Duration = Duration::from_secs(120);

/// What makes Chromium run without a display, with WebGL by SwiftShader, and ask nobody anything.
const FLAGS: [&str; 12] = [
    "--headless",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0",
];

/// A browser with the page open.
pub struct Browser {
    child: Child,
    folder: PathBuf,
    socket: WebSocket<TcpStream>,
    messages: u64,
    loaded: Duration,
    loaded_at: Instant,
}

fn escaped(text: &str) -> String {
    text.bytes().map(|byte| format!("%{byte:02x}")).collect()
}

fn page_folder() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.join("target/page")
}

fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let positions =
        std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name)));
    positions.into_iter().find(|position| position.is_file())
}

impl Browser {
    /// What is missing for the page to be seen; `None` where nothing is.
    pub fn missing() -> Option<&'static str> {
        match (chromium(), page_folder().join("index.html").is_file()) {
            (None, _) => Some("Chromium is not installed"),
            (_, false) => Some("there is no page: `workbench/page/build` makes it"),
            _ => None,
        }
    }

    /// The page in a window of a size in points, in the dark; where it can be had (see [`Self::missing`]).
    pub fn open(size: [u32; 2]) -> Self {
        Self::start(size, 1.0, "")
    }

    /// The page with a study on its table, on a screen that has so many pixels for a point.
    pub fn open_fine(size: [u32; 2], scale: f64, study: &str) -> Self {
        Self::start(size, scale, &format!("#{}", escaped(study)))
    }

    /// The page with a study on its table, pulling by itself for so many frames.
    pub fn open_with(size: [u32; 2], study: &str, frames: usize) -> Self {
        Self::start(size, 1.0, &format!("?frames={frames}#{}", escaped(study)))
    }

    fn start(size: [u32; 2], scale: f64, rest: &str) -> Self {
        let program = chromium().expect("Chromium");
        let port = serve(page_folder());
        let folder =
            std::env::temp_dir().join(format!("gelbench-page-{}-{port}", std::process::id()));
        let child = Command::new(program)
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", folder.display()))
            .arg(format!("--window-size={},{}", size[0], size[1]))
            .arg(format!("--force-device-scale-factor={scale}"))
            .arg("about:blank")
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .expect("Chromium starts");
        let socket = connect(&folder);
        let mut browser = Self {
            child,
            folder,
            socket,
            messages: 0,
            loaded: Duration::ZERO,
            loaded_at: Instant::now(),
        };
        browser.set(size, false);
        let begun = Instant::now();
        browser.call(
            "Page.navigate",
            &json!({ "url": format!("http://127.0.0.1:{port}/{rest}") }),
        );
        browser.until(|state| state.is_object());
        (browser.loaded, browser.loaded_at) = (begun.elapsed(), Instant::now());
        browser
    }

    fn set(&mut self, size: [u32; 2], light: bool) {
        self.call(
            "Emulation.setDeviceMetricsOverride",
            &json!({
                "width": size[0], "height": size[1], "deviceScaleFactor": 0, "mobile": false
            }),
        );
        let scheme = if light { "light" } else { "dark" };
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call(
            "Emulation.setEmulatedMedia",
            &json!({ "features": features }),
        );
    }

    /// Shows the page in another size in points, in the light or in the dark, and waits until it is drawn so.
    #[track_caller]
    pub fn show(&mut self, size: [u32; 2], light: bool) {
        self.set(size, light);
        self.until(|state| {
            let drawn = [0, 1].map(|axis| state["size"][axis].as_f64().map(|side| side as u32));
            drawn == size.map(Some) && state["dark"] == json!(!light)
        });
    }

    /// How long it took until the first frame was drawn.
    pub fn loaded(&self) -> Duration {
        self.loaded
    }

    /// How long ago that was.
    pub fn since_loaded(&self) -> Duration {
        self.loaded_at.elapsed()
    }

    /// Calls a method of the browser's protocol.
    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.messages += 1;
        let number = self.messages;
        let text = json!({ "id": number, "method": method, "params": parameters }).to_string();
        self.socket
            .send(Message::text(text))
            .expect("the browser listens");
        loop {
            let message = self.socket.read().expect("the browser answers");
            let Ok(text) = message.to_text() else {
                continue;
            };
            let Ok(answer) = serde_json::from_str::<Value>(text) else {
                continue;
            };
            if answer["id"] == json!(number) {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }

    fn evaluate(&mut self, script: &str) -> Value {
        let reply = self.call(
            "Runtime.evaluate",
            &json!({ "expression": script, "returnByValue": true }),
        );
        reply["result"]["value"].clone()
    }

    /// What the page tells, as soon as something holds of it.
    #[track_caller]
    pub fn until(&mut self, holds: impl Fn(&Value) -> bool) -> Value {
        self.until_within(PATIENCE, holds)
    }

    /// The same with another patience.
    #[track_caller]
    pub fn until_within(&mut self, patience: Duration, holds: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let state = self.evaluate("window.gelbench ? window.gelbench.told() : null");
            if state.is_object() && holds(&state) {
                return state;
            }
            if begun.elapsed() > patience {
                let page = self.evaluate("document.body.innerText");
                panic!("it does not come about: {state}; the page says {page}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Drags with the mouse in ten steps.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        let mut mouse = |kind: &str, [x, y]: [f64; 2], buttons: u32| {
            let button = if kind == "mouseMoved" && buttons == 0 {
                "none"
            } else {
                "left"
            };
            self.call("Input.dispatchMouseEvent", &json!({
                "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1
            }));
            std::thread::sleep(Duration::from_millis(30));
        };
        mouse("mouseMoved", from, 0);
        mouse("mousePressed", from, 1);
        for step in 1..=10 {
            let share = f64::from(step) / 10.0;
            mouse(
                "mouseMoved",
                [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])),
                1,
            );
        }
        mouse("mouseReleased", to, 0);
    }

    /// Drags with a finger in ten steps.
    pub fn drag_with_a_finger(&mut self, from: [f64; 2], to: [f64; 2]) {
        let mut finger = |kind: &str, at: Option<[f64; 2]>| {
            let points: Vec<Value> = at.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
            self.call(
                "Input.dispatchTouchEvent",
                &json!({ "type": kind, "touchPoints": points }),
            );
        };
        finger("touchStart", Some(from));
        for step in 1..=10 {
            let share = f64::from(step) / 10.0;
            let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            finger("touchMove", Some(at));
        }
        finger("touchEnd", None);
    }

    /// Clicks with the mouse.
    pub fn click(&mut self, at: [f64; 2]) {
        self.mouse("mouseMoved", at);
        self.mouse("mousePressed", at);
        self.mouse("mouseReleased", at);
    }

    fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let (button, buttons) = match kind {
            "mousePressed" => ("left", 1),
            "mouseReleased" => ("left", 0),
            _ => ("none", 0),
        };
        self.call(
            "Input.dispatchMouseEvent",
            &json!({
                "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1
            }),
        );
        std::thread::sleep(Duration::from_millis(60));
    }

    /// Presses a button that the page tells the place of, as somebody does: points at it, sees it drawn where it stays,
    /// and clicks.
    #[track_caller]
    pub fn press_button(&mut self, name: &str) {
        let mut at = self.position(name);
        loop {
            for aside in [1.0, 0.0] {
                let drawn = self.until(|_| true)["drawn"].as_u64();
                self.mouse("mouseMoved", [at[0] + aside, at[1]]);
                self.until(|state| state["drawn"].as_u64() > drawn);
            }
            let still = self.position(name);
            if still == at {
                break;
            }
            at = still;
        }
        self.click(at);
    }

    #[track_caller]
    fn position(&mut self, name: &str) -> [f64; 2] {
        let state = self.until(|state| state["places"][name].is_array());
        [0, 1].map(|axis| state["places"][name][axis].as_f64().expect("a place"))
    }

    /// Presses a key.
    pub fn press(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call(
                "Input.dispatchKeyEvent",
                &json!({ "type": kind, "key": key, "code": key }),
            );
        }
    }

    /// A folder into which the browser puts what it is given.
    pub fn downloads(&mut self) -> PathBuf {
        let folder = self.folder.join("downloads");
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.display().to_string();
        self.call(
            "Page.setDownloadBehavior",
            &json!({ "behavior": "allow", "downloadPath": path }),
        );
        folder
    }

    /// Presses a key with Control.
    pub fn press_with_control(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call(
                "Input.dispatchKeyEvent",
                &json!({ "type": kind, "modifiers": 2, "key": key, "code": key }),
            );
        }
    }

    /// Drops a file on the page.
    pub fn drop_file(&mut self, name: &str, text: &str) {
        let script = format!(
            "{{ const files = new DataTransfer(); files.items.add(new File([{}], {})); \
             const drop = (kind) => document.querySelector('canvas').dispatchEvent(\
             new DragEvent(kind, {{ dataTransfer: files, bubbles: true, cancelable: true }})); drop('dragover'); drop('drop'); }}",
            json!(text),
            json!(name)
        );
        self.evaluate(&script);
    }

    /// Leaves a picture, where somebody wants to look at it.
    pub fn picture(&mut self, name: &str) {
        let Some(folder) = std::env::var_os("GELBENCH_SCREENSHOTS") else {
            return;
        };
        std::thread::sleep(Duration::from_millis(300));
        let taken = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        let data = taken["data"].as_str().unwrap_or_default();
        let path = Path::new(&folder).join(format!("{name}.png"));
        let picture = STANDARD.decode(data).expect("a picture");
        std::fs::write(path, picture).expect("a folder for pictures");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
        drop(std::fs::remove_dir_all(&self.folder));
    }
}

/// The first page of the browser whose data are in a folder, as soon as it says where it listens.
fn connect(folder: &Path) -> WebSocket<TcpStream> {
    let begun = Instant::now();
    let port = loop {
        let text = std::fs::read_to_string(folder.join("DevToolsActivePort"));
        if let Some(port) = text
            .ok()
            .and_then(|text| text.lines().next().map(str::to_owned))
        {
            break port;
        }
        assert!(
            begun.elapsed() < PATIENCE,
            "Chromium does not say where it listens"
        );
        std::thread::sleep(Duration::from_millis(50));
    };
    let address = format!("127.0.0.1:{port}");
    let list = get(&address, "/json/list");
    let pages: Value = serde_json::from_str(&list).expect("a list of pages");
    let page = pages
        .as_array()
        .and_then(|pages| pages.iter().find(|page| page["type"] == "page"));
    let url = page.expect("a page")["webSocketDebuggerUrl"]
        .as_str()
        .expect("its address")
        .to_owned();
    let stream = TcpStream::connect(&address).expect("the browser listens");
    let (socket, _) = tungstenite::client(url, stream).expect("a web socket");
    socket
}

fn get(address: &str, path: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("the browser listens");
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n"
    )
    .expect("a request");
    let mut reader = BufReader::new(stream);
    let mut length = 0;
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).expect("a head");
        if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().expect("a length");
        }
        if line.trim().is_empty() {
            break;
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).expect("a body");
    String::from_utf8(body).expect("text")
}
