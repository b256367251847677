//! Radars and results over sockets.
