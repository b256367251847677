//! What was met in a file.

use boresight_core::Remark;

/// What was met in a file, and what was lost of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct McapCounts {
    /// Bytes taken.
    pub bytes: u64,
    /// Messages, wanted or not, but those of chunks that are damaged.
    pub messages: u64,
    /// Chunks.
    pub chunks: u64,
    /// Chunks left out: their bytes or their check sums are wrong.
    pub damaged_chunks: u64,
    /// Chunks left out: packed in a way that is not known, or too large.
    pub unread_chunks: u64,
    /// Wanted messages left out, as they are too long to be held.
    pub long_messages: u64,
    /// Records beside messages left out, as they are too long to be held.
    pub long_records: u64,
    /// Messages of channels that the file does not name before them.
    pub nameless_messages: u64,
    /// Bytes that follow damage, or belong to a record that the end of the file cuts.
    pub lost_bytes: u64,
    /// Messages that the file's own statistics count.
    pub stated_messages: Option<u64>,
    /// Whether the file has its end.
    pub complete: bool,
    /// What was wrong where reading stopped, with its place in the file.
    pub damage: Option<(u64, &'static str)>,
    /// Whether the check sum of all data is wrong.
    pub wrong_sum: bool,
}

impl McapCounts {
    /// What was lost, in words.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut remarks = vec![];
        let mut say = |code, text: String| remarks.push(Remark::new(code, text));
        if let Some((offset, what)) = self.damage {
            say(
                "damaged-file",
                format!(
                    "the file is damaged at byte {offset} ({what}); bytes not read: {}",
                    self.lost_bytes
                ),
            );
        } else if !self.complete {
            say(
                "cut-file",
                format!(
                    "the file has no end: it was cut, or its recording was; bytes of the record it ends in: {}",
                    self.lost_bytes
                ),
            );
        } else if self.lost_bytes > 0 {
            say("skipped-bytes", format!("bytes after the end of the file: {}", self.lost_bytes));
        }
        for (count, code, what) in [
            (self.damaged_chunks, "damaged-chunks", "chunks left out because they are damaged"),
            (
                self.unread_chunks,
                "unread-chunks",
                "chunks left out because their compression is not known or they are too large",
            ),
            (self.long_messages, "long-messages", "messages left out because they are too long"),
            (
                self.long_records,
                "long-records",
                "schemas or channels left out because they are too long",
            ),
            (
                self.nameless_messages,
                "nameless-messages",
                "messages of channels that the file does not name",
            ),
        ] {
            if count > 0 {
                say(code, format!("{what}: {count}"));
            }
        }
        if self.wrong_sum {
            say("wrong-sum", "the check sum of the file's data is wrong".into());
        }
        if let Some(stated) = self.stated_messages
            && stated != self.messages
        {
            say(
                "missing-messages",
                format!("messages by the file's own count {stated}, found {}", self.messages),
            );
        }
        remarks
    }
}
