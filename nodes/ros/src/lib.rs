//! r2r adapters and the ROS 2 executables.
