mod bag;
mod detections;
mod recordings;
