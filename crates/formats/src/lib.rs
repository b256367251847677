//! Readers and writers of the files radar engineers have.
//!
//! - [`mmwave_cfg`]: the text configuration of Texas Instruments' mmWave boards.
//! - [`mmwave_studio`]: the JSON configuration of mmWave Studio.
//! - [`dca1000`]: raw samples recorded by the DCA1000 capture card, or of a cascade of chips, read with such a
//!   configuration.
//! - [`ti_uart`]: the packets a board's demo firmware sends over its serial port.
//! - [`npy`]: NumPy arrays.
//! - [`hdf5`]: arrays of HDF5 files, MATLAB's 7.3 among them.
//! - [`pcd`]: point clouds of the Point Cloud Library.
//! - [`tables`]: detections and snapshots as CSV.
//! - [`radarscenes`]: sequences of the `RadarScenes` data set.
//! - [`mcap`] and [`ros`]: recordings of robots and test cars, and the messages in them.
//! - [`drive_log`]: drives, as point clouds and the car's motion.
//! - [`foxglove`]: drives as messages for viewers, and [`mcap`]: files of them.
//! - [`json`]: results in the names and units that JavaScript has them in.
//!
//! All readers but those of streams work on bytes in memory, take nothing on trust from a header before comparing it
//! with what is there, and say where a file is wrong.
//!
//! # Example
//!
//! ```
//! use boresight_formats::{FormatError, NpyArray, npy};
//!
//! let bytes = npy::write(&[2, 3], &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])?;
//! let array = NpyArray::parse(&bytes)?;
//! assert_eq!(array.shape, [2, 3]);
//! assert_eq!(array.to_f64().map(|numbers| numbers[4]), Some(4.0));
//!
//! // A file that ends early is refused, and the error says where.
//! let cut = NpyArray::parse(&bytes[..bytes.len() - 1]);
//! assert!(matches!(cut, Err(FormatError::Binary { format: "npy", .. })), "{cut:?}");
//! # Ok::<(), FormatError>(())
//! ```

pub mod dca1000;
pub mod drive_log;
mod error;
pub mod foxglove;
pub mod hdf5;
pub mod json;
pub mod mcap;
pub mod mmwave_cfg;
pub mod mmwave_studio;
pub mod npy;
pub mod pcd;
pub mod radarscenes;
pub mod ros;
pub mod tables;
pub mod ti_uart;

pub use boresight_core::Remark;
pub use dca1000::{Capture, Layout, RawFrame, ReadingOptions, Settled};
pub use drive_log::{
    DriveFormat, DriveRead, DriveTopic, DropReason, McapDriveReader, MountingSource, ReadReport,
    TopicOptions,
};
pub use error::FormatError;
pub use mmwave_cfg::{Compensation, RadarConfig, SubFrame};
pub use npy::{NpyArray, NpyData};
pub use pcd::PointCloud;
pub use ti_uart::{BoardFrame, BoardLog, BoardLogCounts, BoardObject, UartStream};
