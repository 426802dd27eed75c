//! A web worker: the same program a second time, which answers messages. Questions and answers travel as bytes.

use std::any::Any;
use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;
use web_sys::{MessageEvent, WorkerOptions, WorkerType};

use super::{Wake, Worker};

/// The script in the folder of the page that starts the program as a worker.
const SCRIPT: &str = "./worker.js";

/// The way to a web worker and back; it ends with the link.
pub struct Link<W: Worker> {
    worker: web_sys::Worker,
    answers: Rc<RefCell<VecDeque<W::Answer>>>,
    /// What the browser calls when a message comes.
    _listener: Closure<dyn FnMut(MessageEvent)>,
}

impl<W: Worker> Link<W> {
    pub fn new(wake: Wake) -> Self {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        options.set_name(W::NAME);
        let worker = web_sys::Worker::new_with_options(SCRIPT, &options)
            .expect("a browser with module workers");
        let answers = Rc::new(RefCell::new(VecDeque::new()));
        let received = Rc::clone(&answers);
        let listener = Closure::new(move |event: MessageEvent| {
            let bytes = Uint8Array::new(&event.data()).to_vec();
            if let Ok(answer) = postcard::from_bytes(&bytes) {
                received.borrow_mut().push_back(answer);
            }
            wake();
        });
        worker.set_onmessage(Some(listener.as_ref().unchecked_ref()));
        Self {
            worker,
            answers,
            _listener: listener,
        }
    }

    pub fn send(&mut self, question: W::Question) {
        let bytes = postcard::to_stdvec(&question).expect("questions are plain data");
        // A message that cannot be sent has no answer; after a stop a new worker begins.
        drop(self.worker.post_message(&Uint8Array::from(&bytes[..])));
    }

    pub fn receive(&mut self) -> Option<W::Answer> {
        self.answers.borrow_mut().pop_front()
    }
}

impl<W: Worker> Drop for Link<W> {
    fn drop(&mut self) {
        self.worker.terminate();
    }
}

thread_local! {
    /// The workers that this instance of the program is, by name.
    static SELVES: RefCell<BTreeMap<&'static str, Box<dyn Any>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Answers a message as the worker `W`; nothing where the message is none of its questions.
pub fn answer<W: Worker>(question: &[u8]) -> Option<Vec<u8>> {
    let question = postcard::from_bytes(question).ok()?;
    let answer = SELVES.with_borrow_mut(|selves| {
        let worker = selves.entry(W::NAME).or_insert_with(|| Box::<W>::default());
        let worker = worker.downcast_mut::<W>().expect("one worker of a name");
        worker.answer(&question)
    });
    postcard::to_stdvec(&answer).ok()
}
