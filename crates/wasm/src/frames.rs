//! Results of the chain as plain objects.

use crate::write::{Record, finite_db, float32, float64, list};
use boresight_pipeline::{Counts, Detection, FrameResult};

/// Result of a frame, or of several combined.
pub fn frame_record(result: &FrameResult) -> Record {
    let map: Vec<f32> = result.range_doppler_db.iter().copied().collect();
    let warning =
        |code: &str, message: &str| Record::new().with("code", code).with("message", message);
    Record::new()
        .with("frame", result.frame)
        .with("frames", result.frames)
        .with("rangeM", float64(&result.range_m))
        .with("rateMps", float64(&result.rate_mps))
        .with("rangeProfileDb", float64(&result.range_profile_db))
        .with("rangeDopplerDb", float32(&map))
        .with("shape", list(result.range_doppler_db.shape().iter().copied()))
        .with("detections", list(result.detections.iter().map(detection_record)))
        .with("counts", counts_record(&result.counts))
        .with("warnings", list(result.warnings.iter().map(|w| warning(w.code, &w.message))))
}

fn detection_record(detection: &Detection) -> Record {
    Record::new()
        .with("frame", detection.frame)
        .with("rangeM", detection.range_m)
        .with("rateMps", detection.rate_mps)
        .with("azimuthDeg", detection.azimuth_rad.to_degrees())
        .with("elevationDeg", detection.elevation_rad.to_degrees())
        .with("powerDb", finite_db(detection.power))
        .with("snrDb", finite_db(detection.snr))
        .with("rangeBin", detection.range_bin)
        .with("dopplerBin", detection.doppler_bin)
}

/// What became of cells and samples.
pub fn counts_record(counts: &Counts) -> Record {
    Record::new()
        .with("cellsOverThreshold", counts.cells_over_threshold)
        .with("grouped", counts.grouped)
        .with("outsideRegion", counts.outside_region)
        .with("beyondLimit", counts.beyond_limit)
        .with("withoutAngle", counts.without_angle)
        .with("clippedSamples", counts.clipped_samples)
}
