//! The guide: from the first plate to a condition of your own in the corrector.
