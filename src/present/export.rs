//! A policy for other programs: C sources, an ONNX model, or one JSON document.

mod c;
mod json;
mod onnx;

use crate::base::check::BadInput;
use crate::base::error::Result;
use crate::race::snapshot::{PolicyContent, Snapshot};
use sha2::{Digest, Sha256};

/// What is exported.
#[derive(Clone, Debug)]
pub struct Exported {
    pub snapshot: Snapshot,
    pub content: PolicyContent,
    /// The metadata of the policy's file.
    pub metadata: serde_json::Value,
    /// Of the file that the policy was read from: what `sha256sum` says.
    pub sha256: String,
}

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    C,
    Onnx,
    Json,
}

/// The format of exports of this version, for programs that read them.
const EXPORT: &str = "racer-export-1";

impl Exported {
    /// Of `snapshot`, which was read from a file with these bytes. Fails where its flight ends before its first step.
    pub fn new(snapshot: Snapshot, bytes: &[u8]) -> Result<Self> {
        let content = snapshot.content()?;
        if content.rows.state.is_empty() {
            let expected = "a start inside the flight volume, without which there is no flight to test an export with";
            return Err(BadInput::new("the policy's track", "a start outside of its volume", expected, "").into());
        }
        let metadata = serde_json::from_str(&content.metadata).unwrap_or_default();
        let sha256 = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { snapshot, content, metadata, sha256 })
    }

    /// Names and contents of the files of an export.
    pub fn files(&self, format: ExportFormat) -> Result<Vec<(String, Vec<u8>)>> {
        match format {
            ExportFormat::C => Ok(c::files(self)),
            ExportFormat::Onnx => Ok(vec![("policy.onnx".into(), onnx::model(self))]),
            ExportFormat::Json => Ok(vec![("policy.json".into(), json::document(self)?.into_bytes())]),
        }
    }
}
