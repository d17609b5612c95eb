//! What a procedure wants of the person in front of the axis.

use super::ProcedureError;

/// The person, or whoever answers for them. Asked only while the drive is off.
pub trait Guide {
    /// Tells a result, or what is about to happen.
    fn tell(&mut self, text: &str);

    /// Tells how far a procedure is; the next one takes its place.
    fn progress(&mut self, text: &str);

    /// Asks for a yes or no; `default` is what silence means.
    ///
    /// # Errors
    /// Nobody can answer.
    fn agree(&mut self, question: &str, default: bool) -> Result<bool, ProcedureError>;

    /// Asks for a number, or takes the default.
    ///
    /// # Errors
    /// Nobody can answer.
    fn number(&mut self, question: &str, default: f64) -> Result<f64, ProcedureError>;
}
