//! Undo and redo over any value: its former states, the present one, and those that were undone.

/// A value with its past and its future.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    now: T,
    future: Vec<T>,
    /// Whether the next change belongs to the one before, as while something is dragged.
    gesture: bool,
}

/// Values that are kept.
const KEPT: usize = 200;

impl<T: Clone + PartialEq> History<T> {
    /// Without a past.
    pub fn new(now: T) -> Self {
        Self {
            past: Vec::new(),
            now,
            future: Vec::new(),
            gesture: false,
        }
    }

    /// The value as it is.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Takes a new value over; those of one gesture are one step back together.
    pub fn change(&mut self, next: T, gesture: bool) {
        if next == self.now {
            return;
        }
        let before = std::mem::replace(&mut self.now, next);
        if !(gesture && self.gesture) {
            self.past.push(before);
            if self.past.len() > KEPT {
                self.past.remove(0);
            }
        }
        self.gesture = gesture;
        self.future.clear();
    }

    /// Ends a gesture: what follows is a step of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = false;
    }

    /// Whether there is something to undo, and to redo.
    pub fn steps(&self) -> [bool; 2] {
        [!self.past.is_empty(), !self.future.is_empty()]
    }

    /// Takes the last change back.
    pub fn undo(&mut self) {
        if let Some(before) = self.past.pop() {
            self.future.push(std::mem::replace(&mut self.now, before));
            self.gesture = false;
        }
    }

    /// Redoes what was undone last.
    pub fn redo(&mut self) {
        if let Some(after) = self.future.pop() {
            self.past.push(std::mem::replace(&mut self.now, after));
            self.gesture = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gesture_is_one_step_and_a_change_after_it_another() {
        let mut history = History::new(0);
        for pulled in 1..=5 {
            history.change(pulled, true);
        }
        history.end_gesture();
        history.change(9, true);
        history.undo();
        assert_eq!(*history.now(), 5);
        history.undo();
        assert_eq!((*history.now(), history.steps()), (0, [false, true]));
        history.redo();
        history.redo();
        assert_eq!((*history.now(), history.steps()), (9, [true, false]));
    }

    #[test]
    fn a_change_after_undo_forgets_what_was_taken_back() {
        let mut history = History::new(0);
        history.change(1, false);
        history.undo();
        history.change(2, false);
        assert_eq!(history.steps(), [true, false]);
        history.undo();
        assert_eq!(*history.now(), 0);
    }
}
