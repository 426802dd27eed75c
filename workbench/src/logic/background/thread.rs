//! A thread that answers questions.

use std::sync::mpsc::{Receiver, Sender, channel};

use super::{Wake, Worker};

/// The way to a thread and back. A thread whose link is dropped ends when it has answered.
pub struct Link<W: Worker> {
    questions: Sender<W::Question>,
    answers: Receiver<W::Answer>,
}

impl<W: Worker> Link<W> {
    pub fn new(wake: Wake) -> Self {
        let (questions, asked) = channel::<W::Question>();
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            let mut worker = W::default();
            for question in asked {
                if sender.send(worker.answer(&question)).is_err() {
                    return;
                }
                wake();
            }
        });
        Self { questions, answers }
    }

    pub fn send(&mut self, question: W::Question) {
        // A thread that is gone has panicked: no answer comes, and after a stop a new one begins.
        drop(self.questions.send(question));
    }

    pub fn receive(&mut self) -> Option<W::Answer> {
        self.answers.try_recv().ok()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    use crate::logic::background::{Background, Worker};

    /// Adds up what it is asked, slowly.
    #[derive(Default)]
    struct Sum(u64);

    impl Worker for Sum {
        type Question = u64;
        type Answer = u64;
        const NAME: &'static str = "sum";

        fn answer(&mut self, question: &u64) -> u64 {
            std::thread::sleep(Duration::from_millis(20));
            self.0 += question;
            self.0
        }
    }

    fn wait_for(background: &mut Background<Sum>) -> Vec<u64> {
        let begun = Instant::now();
        let mut all = Vec::new();
        while background.is_busy() && begun.elapsed() < Duration::from_secs(10) {
            all.extend(background.answers());
            std::thread::sleep(Duration::from_millis(1));
        }
        all
    }

    #[test]
    fn the_newest_question_takes_the_place_of_those_that_wait() {
        let woken = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&woken);
        let wake = Arc::new(move || {
            count.fetch_add(1, Ordering::SeqCst);
        });
        let mut background = Background::<Sum>::new(wake);
        for question in [1, 10, 100] {
            background.ask(question);
        }
        assert_eq!(wait_for(&mut background), [1, 101]);
        assert_eq!(woken.load(Ordering::SeqCst), 2);
    }

    #[test]
    fn a_worker_that_was_stopped_says_no_more_and_a_new_one_begins_anew() {
        let mut background = Background::<Sum>::new(Arc::new(|| ()));
        background.ask(1);
        background.stop();
        assert!(!background.is_busy() && background.answers().is_empty());
        background.ask(5);
        assert_eq!(wait_for(&mut background), [5]);
    }
}
