//! A drive that is served, and a viewer of it.
#![allow(clippy::unwrap_used, clippy::panic, dead_code)]

use boresight_core::drive::{Detection, DriveLog, MotionSample, Mounting, Pose, Scan, Sensor};
use boresight_live::foxglove::play::Setup;
use boresight_live::foxglove::{Counts, Play, ServeOptions, Server};
use boresight_mounting::CalibrationOptions;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::net::{SocketAddr, TcpStream};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket};

/// Longest wait for something that should come.
const PATIENCE: Duration = Duration::from_secs(60);

/// A car that goes straight at 10 m/s past points that stand, with two radars, each 2 deg off its nominal angle.
pub fn drive(scans: u32) -> DriveLog {
    let turned_rad = 2_f64.to_radians();
    let nominal = [(1, 0.5), (2, -0.5)];
    let scan = |k: u32| {
        let (sensor, yaw_rad) = nominal[k as usize % 2];
        let detections = (-15..=15)
            .map(|i| {
                let azimuth_rad = 0.05 * f64::from(i);
                let toward = (azimuth_rad + yaw_rad + turned_rad).cos();
                Detection {
                    azimuth_rad: azimuth_rad as f32,
                    range_rate_mps: (-10.0 * toward) as f32,
                    range_m: 20.0 + i as f32,
                    rcs_dbsm: k as f32,
                }
            })
            .collect();
        Scan { time_s: 0.025 * f64::from(k), sensor, detections, labels: vec![] }
    };
    let sample = |k: u32| {
        let time_s = 0.05 * f64::from(k);
        let pose = Some(Pose { x_m: 10.0 * time_s, y_m: 0.0, yaw_rad: 0.0 });
        MotionSample { time_s, yaw_rate_radps: 0.0, speed_mps: Some(10.0), pose }
    };
    let sensor =
        |(id, yaw_rad)| Sensor { id, mounting: Some(Mounting { x_m: 3.5, y_m: 0.0, yaw_rad }) };
    DriveLog {
        sensors: nominal.map(sensor).into(),
        scans: (0..scans).map(scan).collect(),
        motion: (0..scans.div_ceil(2) + 1).map(sample).collect(),
    }
}

/// How the drive is calibrated.
pub fn setup(log: &DriveLog, joint: bool) -> Setup {
    let radars = log.sensors.iter().map(|sensor| {
        let mounting = sensor.mounting.unwrap();
        let options = CalibrationOptions {
            x_m: mounting.x_m,
            nominal_rad: Some(mounting.yaw_rad),
            ..CalibrationOptions::default()
        };
        (sensor.id, options)
    });
    Setup { radars: radars.collect(), joint, network: None }
}

/// Serves a drive while `visit` runs, and says what became of it.
pub fn serve(log: &DriveLog, options: ServeOptions, visit: impl FnOnce(SocketAddr)) -> Counts {
    let over = AtomicBool::new(false);
    let server = Server::bind(ServeOptions { port: 0, ..options }).unwrap();
    let address = server.address().unwrap();
    std::thread::scope(|scope| {
        let serving = scope.spawn(|| {
            let mut play = Play::new(log, &[], setup(log, true)).unwrap();
            let watch = |_: [usize; 2]| {
                if over.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            server.run(&mut play, &watch).unwrap()
        });
        // A visit that fails ends the server all the same.
        let visited = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| visit(address)));
        over.store(true, Ordering::Relaxed);
        let counts = serving.join().unwrap();
        if let Err(panic) = visited {
            std::panic::resume_unwind(panic);
        }
        counts
    })
}

/// A connection that speaks one of the protocols.
pub fn connect(
    address: SocketAddr,
    protocol: &str,
    origin: Option<&str>,
) -> Result<WebSocket<TcpStream>, String> {
    let stream = TcpStream::connect(address).map_err(|error| error.to_string())?;
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut request = format!("ws://{address}/").into_client_request().unwrap();
    let headers = request.headers_mut();
    headers.insert("Sec-WebSocket-Protocol", HeaderValue::from_str(protocol).unwrap());
    if let Some(origin) = origin {
        headers.insert("Origin", HeaderValue::from_str(origin).unwrap());
    }
    tungstenite::client(request, stream).map(|(socket, _)| socket).map_err(|e| e.to_string())
}

/// What a viewer got.
pub struct Viewer {
    pub socket: WebSocket<TcpStream>,
    pub topics: Vec<String>,
    pub got: HashMap<String, Vec<(u64, Value)>>,
    pub statuses: Vec<Value>,
    /// Status, time, rate, whether it sought, and identifier.
    pub playing: Vec<(u8, u64, f32, bool, String)>,
    pub others: Vec<Value>,
    pub time_ns: u64,
}

impl Viewer {
    pub fn new(address: SocketAddr, protocol: &str) -> Self {
        let socket = connect(address, protocol, None).unwrap();
        let mut viewer = Self {
            socket,
            topics: vec![],
            got: HashMap::new(),
            statuses: vec![],
            playing: vec![],
            others: vec![],
            time_ns: 0,
        };
        viewer.until(|viewer| !viewer.topics.is_empty());
        viewer
    }

    /// Asks for all topics that a rule takes, each by the number of its channel and 100.
    pub fn subscribe(&mut self, wanted: impl Fn(&str) -> bool) {
        let subscriptions: Vec<Value> = (0..self.topics.len())
            .filter(|at| wanted(&self.topics[*at]))
            .map(|at| json!({ "id": at + 100, "channelId": at }))
            .collect();
        self.send(&json!({ "op": "subscribe", "subscriptions": subscriptions }));
    }

    pub fn send(&mut self, message: &Value) {
        self.socket.send(Message::Text(message.to_string().into())).unwrap();
    }

    /// Asks for a control of playback.
    pub fn control(&mut self, command: u8, speed: f32, seek_ns: Option<u64>, id: &str) {
        let bytes = [
            &[3, command][..],
            &speed.to_le_bytes(),
            &[u8::from(seek_ns.is_some())],
            &seek_ns.unwrap_or_default().to_le_bytes(),
            &(id.len() as u32).to_le_bytes(),
            id.as_bytes(),
        ]
        .concat();
        self.socket.send(Message::Binary(bytes.into())).unwrap();
    }

    pub fn of(&self, topic: &str) -> &[(u64, Value)] {
        self.got.get(topic).map_or(&[], Vec::as_slice)
    }

    /// Reads until something is so.
    pub fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        let until = Instant::now() + PATIENCE;
        while !is_so(self) {
            assert!(
                Instant::now() < until,
                "it did not come: {:?} {:?}",
                self.statuses,
                self.playing
            );
            self.read();
        }
    }

    pub fn read(&mut self) {
        match self.socket.read().unwrap() {
            Message::Text(text) => {
                let value: Value = serde_json::from_str(&text).unwrap();
                match value["op"].as_str().unwrap() {
                    "advertise" => {
                        let channels = value["channels"].as_array().unwrap();
                        let topics = channels.iter().map(|c| c["topic"].as_str().unwrap().into());
                        self.topics = topics.collect();
                    }
                    "status" => self.statuses.push(value),
                    _ => self.others.push(value),
                }
            }
            Message::Binary(bytes) => self.binary(&bytes),
            _ => {}
        }
    }

    fn binary(&mut self, bytes: &[u8]) {
        let u64_at = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        match bytes[0] {
            1 => {
                let id = u32::from_le_bytes(bytes[1..5].try_into().unwrap());
                let topic = self.topics[id as usize - 100].clone();
                let value = serde_json::from_slice(&bytes[13..]).unwrap();
                self.got.entry(topic).or_default().push((u64_at(5), value));
            }
            2 => self.time_ns = u64_at(1),
            5 => {
                let rate = f32::from_le_bytes(bytes[10..14].try_into().unwrap());
                let id = String::from_utf8(bytes[19..].to_vec()).unwrap();
                self.playing.push((bytes[1], u64_at(2), rate, bytes[14] == 1, id));
            }
            other => panic!("operation {other}"),
        }
    }
}

/// Asks for everything of the drive and gets it.
pub fn sees_all(address: SocketAddr, scans: usize) {
    let mut viewer = Viewer::new(address, "foxglove.websocket.v1");
    viewer.subscribe(|topic| topic == "/radar/1/detections");
    viewer.until(|viewer| viewer.of("/radar/1/detections").len() == scans / 2);
}
