/** Which files are what, by their names. */

/** Of a capture: raw samples, the radar's configuration, the board's log. */
export const CAPTURE_KINDS = ['bin', 'cfg', 'dat'] as const;
/** mmWave Studio writes JSON in place of the .cfg; other JSON belongs to networks. */
export const CAPTURES = new RegExp(`\\.(${CAPTURE_KINDS.join('|')}|mmwave\\.json|setup\\.json)$`, 'i');
/** Calibrations of arrays, as the capture page saves them. */
export const ARRAY_CALIBRATIONS = /\.calibration\.json$/i;
/** What the live page replays; elsewhere they go with a capture. */
export const BOARDS = /\.(dat|cfg)$/i;
export const TABLES = /\.csv(\.gz)?$/i;
/** Recordings of ROS 2 and others, or parts of one. */
export const RECORDINGS = /\.mcap$/i;
/** Tables, HDF5 files, recordings, point clouds, and frames of View-of-Delft, which are numbered. */
export const DRIVES = /(\.(csv|csv\.gz|h5|hdf5|mcap|pcd)|(^|\/)\d{4,9}\.bin)$/i;
export const SESSIONS = /\.boresight$/i;
export const NETWORKS = /\.onnx$/i;
