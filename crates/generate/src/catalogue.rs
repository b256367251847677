//! What is generated, in the order in which it is listed.

use boresight_core::{Geometry, Waveform, WaveformSummary};
use boresight_options::shaped::ComplexArray;
use boresight_options::{Described, Field, Kind, Record};
use serde::Serialize;
use serde_json::Value;

/// Options that users give.
pub struct Entry {
    /// Name in TypeScript and in the schema.
    pub name: &'static str,
    /// Title of its table.
    pub title: &'static str,
    /// What it is.
    pub record: &'static Record,
    /// Its defaults, in the names and units of Rust.
    pub defaults: Value,
}

/// All options.
pub fn entries() -> Result<Vec<Entry>, serde_json::Error> {
    Ok(vec![
        entry::<boresight_aoa::EstimatorOptions>("SharedEstimatorOptions", "Estimators of angle")?,
        entry::<boresight_pipeline::ChainOptions>(
            "DetectionOptions",
            "The chain from frames to detections",
        )?,
        entry::<boresight_array_calibration::CalibrationOptions>(
            "ArrayCalibrationOptions",
            "Calibrating arrays",
        )?,
        plain(
            "SteeringTable",
            "Tables of measured steering vectors",
            boresight_array_calibration::SteeringTable::KIND,
        ),
        entry::<boresight_mounting::CalibrationOptions>("CalibrationOptions", "Mounting angles")?,
        entry::<boresight_fleet::FleetOptions>("FleetOptions", "Fleets of drives")?,
        entry::<boresight_simulate::DriveOptions>("SimulateDriveOptions", "Simulated drives")?,
        entry::<boresight_formats::ReadingOptions>("ReadingOptions", "Reading captures")?,
        entry::<boresight_wasm::region::RegionOptions>("RegionOptions", "Regions of interest")?,
        entry::<boresight_pipeline::regions::RegionChainOptions>(
            "RegionChainOptions",
            "Regions and their targets",
        )?,
        entry::<boresight_simulate::street::StreetOptions>(
            "StreetOptions",
            "The simulated street",
        )?,
        entry::<boresight_simulate::SnapshotRequest>("SnapshotRequest", "Simulated snapshots")?,
        entry::<boresight_simulate::Target>("SnapshotTarget", "Targets of snapshots")?,
        entry::<boresight_simulate::SceneSampling>("SceneSampling", "Scenes drawn by a rule")?,
        entry::<boresight_simulate::CubeRequest>("CubeRequest", "Simulated data cubes")?,
        plain("CubeTarget", "Targets of data cubes", boresight_simulate::CubeTarget::KIND),
        entry::<boresight_aoa::bounds::BoundRequest>("BoundRequest", "Cramer-Rao bounds")?,
        plain("BoundTarget", "Targets of bounds", boresight_aoa::bounds::BoundTarget::KIND),
        plain("MapGrid", "Range-azimuth maps", boresight_image::GridOptions::KIND),
        entry::<boresight_image::ViewGridOptions>("ViewGrid", "Bird's-eye views")?,
        entry::<boresight_aoa::order::counting::CountOptions>("CountOptions", "Counting sources")?,
        entry::<boresight_wasm::drive::ReadDriveOptions>("ReadDriveOptions", "Reading drives")?,
        entry::<boresight_wasm::hdf5::ReadArrayOptions>("ReadArrayOptions", "Reading arrays")?,
        entry::<boresight_core::Limits>("Limits", "What one call may take")?,
    ])
}

/// What functions return, by subject.
pub fn results() -> Vec<(&'static str, Vec<Kind>)> {
    use boresight_wasm::{
        calibration_methods, capture, config, count, drive, estimate, hdf5, image, npy, recording,
        region, street, trajectory,
    };
    vec![
        ("Arrays and waveforms", vec![Geometry::KIND, Waveform::KIND, WaveformSummary::KIND]),
        (
            "Angles",
            vec![
                estimate::MethodInfo::KIND,
                boresight_aoa::suits::Unsuited::KIND,
                boresight_aoa::Estimate::KIND,
                boresight_aoa::BatchColumns::KIND,
                count::CountResult::KIND,
                boresight_aoa::bounds::Bound::KIND,
            ],
        ),
        (
            "Simulation",
            vec![
                ComplexArray::KIND,
                boresight_simulate::CubeColumns::KIND,
                boresight_simulate::Snapshots::KIND,
                boresight_simulate::street::Street::KIND,
                street::SimulatedStreet::KIND,
            ],
        ),
        (
            "Captures and their chain",
            vec![
                config::ConfigRecord::KIND,
                region::RegionOfInterest::KIND,
                capture::CaptureInfo::KIND,
                recording::CascadeCapture::KIND,
                recording::RecordingParts::KIND,
                boresight_pipeline::FrameResult::KIND,
                boresight_pipeline::FrameCells::KIND,
                boresight_pipeline::CellExplanation::KIND,
                boresight_pipeline::regions::RegionFrame::KIND,
            ],
        ),
        (
            "Array calibration",
            vec![
                boresight_core::ArrayCalibration::KIND,
                boresight_array_calibration::CalibrationResult::KIND,
            ],
        ),
        (
            "Images",
            vec![
                image::ImageDefaults::KIND,
                boresight_image::MapColumns::KIND,
                boresight_image::ViewColumns::KIND,
                boresight_image::SidelobeMeasure::KIND,
            ],
        ),
        (
            "Mounting angles",
            vec![
                calibration_methods::CalibrationMethodInfo::KIND,
                boresight_mounting::FrameOutcome::KIND,
                boresight_mounting::AngleEstimate::KIND,
                boresight_mounting::Outlook::KIND,
                trajectory::Trajectory::KIND,
            ],
        ),
        ("Fleets", vec![boresight_fleet::Fleet::KIND]),
        (
            "Networks",
            vec![
                boresight_wasm_neural::NetworkDescription::KIND,
                boresight_aoa::SourceProbabilities::KIND,
            ],
        ),
        (
            "Drives",
            vec![
                boresight_formats::DropReason::KIND,
                drive::DriveScenarioInfo::KIND,
                drive::DriveRecord::KIND,
                drive::SimulatedDriveRecord::KIND,
            ],
        ),
        (
            "Files and boards",
            vec![
                npy::NpyRecord::KIND,
                hdf5::ArrayRecord::KIND,
                boresight_formats::BoardFrame::KIND,
                boresight_formats::BoardLogCounts::KIND,
                boresight_formats::BoardLog::KIND,
            ],
        ),
    ]
}

fn entry<T: Described + Default + Serialize>(
    name: &'static str,
    title: &'static str,
) -> Result<Entry, serde_json::Error> {
    let defaults = serde_json::to_value(T::default())?;
    Ok(Entry { defaults, ..plain(name, title, T::KIND) })
}

/// Options that mean nothing until they are given.
fn plain(name: &'static str, title: &'static str, kind: Kind) -> Entry {
    let record = match kind {
        Kind::Record(record) => record,
        _ => &Record { name: "", doc: "", fields: &[] },
    };
    Entry { name, title, record, defaults: Value::Null }
}

/// A field as users see it. Flat fields are replaced by their own fields.
pub struct Shown<'a> {
    pub field: &'static Field,
    pub default: Option<&'a Value>,
}

/// Returns the fields of a record with their defaults, flat fields replaced by their own.
pub fn shown<'a>(record: &'static Record, defaults: Option<&'a Value>) -> Vec<Shown<'a>> {
    let mut all = vec![];
    for field in record.fields {
        let default = defaults.and_then(|defaults| defaults.get(field.name));
        match (field.flat, field.kind) {
            (true, Kind::Record(inner)) => all.extend(shown(inner, default)),
            _ => all.push(Shown { field, default }),
        }
    }
    all
}
