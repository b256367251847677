/** Which files are what, by their names. */

/** Of a capture: raw samples, the radar's configuration, the board's log. */
export const CAPTURE_KINDS = ['bin', 'cfg', 'dat'] as const;
/** mmWave Studio writes JSON in place of the .cfg; other JSON belongs to networks. */
export const CAPTURES = new RegExp(`\\.(${CAPTURE_KINDS.join('|')}|mmwave\\.json|setup\\.json)$`, 'i');
/** What the live page replays; elsewhere they go with a capture. */
export const BOARDS = /\.(dat|cfg)$/i;
export const TABLES = /\.csv(\.gz)?$/i;
/** Tables and HDF5 files. */
export const DRIVES = /\.(csv|csv\.gz|h5|hdf5)$/i;
export const SESSIONS = /\.boresight$/i;
export const NETWORKS = /\.onnx$/i;
