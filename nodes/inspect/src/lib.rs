//! TickRecord and scene to rerun.
