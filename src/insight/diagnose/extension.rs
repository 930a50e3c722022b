//! The extended vehicle: what of the findings it keeps, and whether it predicts worse than the base.

pub mod extend;
pub mod keep;
pub mod names;
pub mod own_numbers;
pub mod unpaid_forms;
pub mod worse;
