//! Thread set-up, clock, latency histogram, rings and latest-value cells.
