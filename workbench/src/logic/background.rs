//! Work in the background: by a thread on the desktop, by a web worker in the browser. Of the questions that come while one is
//! being answered only the newest is kept, so that the answers keep up with the user.

use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;

#[cfg(not(target_arch = "wasm32"))]
mod thread;
#[cfg(target_arch = "wasm32")]
mod worker;

#[cfg(not(target_arch = "wasm32"))]
use thread::Link;
#[cfg(target_arch = "wasm32")]
use worker::Link;

#[cfg(target_arch = "wasm32")]
pub use worker::answer;

/// Somebody who answers questions, one after the other, and may remember.
pub trait Worker: Default + 'static {
    /// The question that it answers.
    type Question: Serialize + DeserializeOwned + Send + 'static;
    /// Its answer.
    type Answer: Serialize + DeserializeOwned + Send + 'static;
    /// Its name, by which the page finds it.
    const NAME: &'static str;

    /// Answers.
    fn answer(&mut self, question: &Self::Question) -> Self::Answer;
}

/// Called when there is an answer.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A worker at its place.
pub struct Background<W: Worker> {
    wake: Wake,
    link: Option<Link<W>>,
    busy: bool,
    waiting: Option<W::Question>,
}

impl<W: Worker> Background<W> {
    /// One that begins when it is asked.
    pub fn new(wake: Wake) -> Self {
        Self {
            wake,
            link: None,
            busy: false,
            waiting: None,
        }
    }

    /// Asks; a question that still waits gives way.
    pub fn ask(&mut self, question: W::Question) {
        if self.busy {
            self.waiting = Some(question);
            return;
        }
        let wake = &self.wake;
        let link = self.link.get_or_insert_with(|| Link::new(Arc::clone(wake)));
        link.send(question);
        self.busy = true;
    }

    /// The answers that have come.
    pub fn answers(&mut self) -> Vec<W::Answer> {
        let mut answers = Vec::new();
        while let Some(answer) = self.link.as_mut().and_then(Link::receive) {
            answers.push(answer);
            self.busy = false;
            if let Some(question) = self.waiting.take() {
                self.ask(question);
            }
        }
        answers
    }

    /// Whether an answer is still to come.
    pub fn is_busy(&self) -> bool {
        self.busy
    }

    /// Stops what is being done; the next question finds a new worker, which remembers nothing.
    pub fn stop(&mut self) {
        (self.link, self.busy, self.waiting) = (None, false, None);
    }
}
