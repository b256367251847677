//! What the last panic said. A panic traps the instance, whose memory can still be read.

use std::cell::RefCell;
use wasm_bindgen::prelude::wasm_bindgen;

thread_local! {
    static LAST: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Makes panics leave their message for [`last_panic`]; runs when the module is instantiated.
#[wasm_bindgen(start)]
fn remember_panics() {
    std::panic::set_hook(Box::new(|info| {
        let message = info.to_string();
        LAST.with(|last| {
            if let Ok(mut last) = last.try_borrow_mut() {
                *last = message;
            }
        });
    }));
}

/// Message and place of the last panic; empty if there was none.
#[wasm_bindgen(js_name = lastPanic)]
pub fn last_panic() -> String {
    LAST.with(|last| last.try_borrow().map(|text| text.clone()).unwrap_or_default())
}
