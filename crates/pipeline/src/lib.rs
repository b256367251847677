//! From raw FMCW captures to detections with angles.
