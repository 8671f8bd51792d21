use triple_buffer::{Input, Output};

/// A latest-value cell: the writer never waits, the reader always sees the newest whole value, and values between two
/// reads are lost on purpose. Three buffers, made once.
#[must_use]
pub fn latest<T: Clone + Send>(initial: &T) -> (LatestWriter<T>, LatestReader<T>) {
    let (input, output) = triple_buffer::triple_buffer(initial);
    (LatestWriter(input), LatestReader(output))
}

/// The writing end of [`latest`].
#[derive(Debug)]
pub struct LatestWriter<T: Send>(Input<T>);

impl<T: Send> LatestWriter<T> {
    /// Publishes a value.
    pub fn write(&mut self, value: T) {
        self.0.write(value);
    }

    /// Fills the hidden buffer in place (it holds some older value), then publishes it: for values that own memory, so
    /// that nothing is allocated or freed.
    pub fn write_with(&mut self, fill: impl FnOnce(&mut T)) {
        fill(self.0.input_buffer_mut());
        self.0.publish();
    }
}

/// The reading end of [`latest`].
#[derive(Debug)]
pub struct LatestReader<T: Send>(Output<T>);

impl<T: Send> LatestReader<T> {
    /// The newest value.
    pub fn read(&mut self) -> &T {
        self.0.read()
    }

    /// Whether a value has been published that was not read yet.
    #[must_use]
    pub fn updated(&self) -> bool {
        self.0.updated()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reader_sees_the_newest_value_whole() {
        let (mut writer, mut reader) = latest(&[0u64; 64]);
        let writing = std::thread::spawn(move || {
            for n in 1..=20_000u64 {
                writer.write([n; 64]);
            }
        });
        let mut last = 0;
        while last < 20_000 {
            let value = *reader.read();
            assert!(value.iter().all(|v| *v == value[0]), "torn");
            assert!(value[0] >= last, "went back");
            last = value[0];
        }
        writing.join().unwrap();
        assert!(!reader.updated());
    }
}
