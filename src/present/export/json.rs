//! Everything as one document: the file's metadata, and its tensors as numbers.

use super::{EXPORT, Exported};
use crate::base::error::{Error, Result};
use serde_json::{Map, Value, json};

/// The document.
pub fn document(exported: &Exported) -> Result<String> {
    let tensors: Map<String, Value> = exported
        .content
        .tensors
        .iter()
        .map(|t| (t.name.clone(), json!({ "shape": t.shape, "values": t.numbers() })))
        .collect();
    let metadata = &exported.metadata;
    let document = json!({
        "export": EXPORT,
        "sha256": exported.sha256,
        "format": metadata["format"],
        "racer": metadata["racer"],
        "flying": metadata["flying"],
        "training": metadata["training"],
        "tensors": tensors,
    });
    Ok(serde_json::to_string(&document).map_err(Error::encode("the policy"))? + "\n")
}
