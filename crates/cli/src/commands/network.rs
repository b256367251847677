//! `boresight network`.

use crate::arguments::TellArguments;
use crate::error::CliError;
use crate::files::Files;
use crate::network;
use boresight_options::Named;

/// What a model is, by its file and its card.
pub fn run(arguments: &TellArguments, files: &Files) -> Result<String, CliError> {
    let model = network::load(&arguments.model, arguments.card.as_deref(), files)?;
    let mut text = format!("kind        {}\n", model.kind().name());
    for port in model.inputs() {
        text += &format!("input       {port}\n");
    }
    for port in model.outputs() {
        text += &format!("output      {port}\n");
    }
    let Some(card) = model.card() else {
        return Ok(text + "card        none\n");
    };
    text += &format!(
        "name        {}\ntitle       {}\nreference   {}\nparameters  {}\n",
        card.name, card.title, card.reference, card.parameters
    );
    let optional = [
        ("confidence", card.confidence.map(|least| format!("{least} or more"))),
        ("targets", card.targets.map(|count| count.to_string())),
        ("array", card.data.array.clone()),
        ("waveform", card.data.waveform.clone()),
        ("view", card.data.field_of_view_deg.map(|deg| format!("within {deg} deg of boresight"))),
        ("SHA-256", card.sha256.clone()),
    ];
    for (name, value) in optional {
        if let Some(value) = value {
            text += &format!("{name:<11} {value}\n");
        }
    }
    Ok(text)
}
