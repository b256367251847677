//! Progress told to JavaScript, which may answer that it is enough.

use boresight_core::Progress;
use js_sys::Function;
use std::ops::ControlFlow;
use wasm_bindgen::JsValue;

/// Calls `report`; an exception in it counts as a request to stop.
pub fn reporter(report: Option<Function>) -> impl FnMut(Progress) -> ControlFlow<()> {
    move |Progress { done, total }| {
        let Some(report) = &report else { return ControlFlow::Continue(()) };
        let (done, total) = (JsValue::from(done), JsValue::from(total));
        match report.call2(&JsValue::UNDEFINED, &done, &total) {
            Ok(answer) if answer.as_bool() != Some(false) => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}
