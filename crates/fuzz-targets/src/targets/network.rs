//! A network's ONNX file and its card: what is accepted has the ports of its kind, and a card comes back as it was written.
//! The first two bytes are the length of the card, little end first.

use boresight_neural::{Card, Model};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let [low, high, rest @ ..] = bytes else { return };
    let length = usize::from(u16::from_le_bytes([*low, *high])).min(rest.len());
    let (json, onnx) = rest.split_at(length);
    let card = Card::from_json(json).ok();
    if let Some(card) = &card {
        let text = serde_json::to_vec(card).expect("cards are JSON");
        assert_eq!(&Card::from_json(&text).expect("what was written is read"), card);
    }
    for card in [None, card.as_ref()] {
        if let Ok(model) = Model::load(onnx, card) {
            assert!(!model.inputs().is_empty() && !model.outputs().is_empty());
            assert_eq!(model.sha256().len(), 64);
        }
    }
}
