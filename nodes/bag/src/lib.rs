//! rosbag2 (MCAP) directories, written and read without ROS.
