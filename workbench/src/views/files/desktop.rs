//! Export of files on the desktop: a dialogue asks where, and files that the workbench has not written itself are only replaced after a
//! question.

use std::collections::BTreeMap;
use std::fs;
use std::future::Future;
use std::io;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{self, Poll, Waker};
use std::time::{Duration, Instant};

use eframe::egui::Context;
use rfd::AsyncFileDialog;

use super::{Event, Outgoing};
use crate::logic::background::Wake;
use crate::views::question;

/// What a dialogue asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    /// A file to be opened.
    Open,
    /// A file to be written, with a name for it.
    Save(String),
    /// A folder in which a folder of a name is written.
    Folder(String),
}

/// What was chosen; nothing where the user cancelled.
type Chosen = Pin<Box<dyn Future<Output = Option<PathBuf>>>>;

/// Shows a dialogue that begins in a folder.
pub type Choose = Box<dyn Fn(&Choice, Option<&Path>) -> Chosen>;

/// A dialogue that is open.
struct Dialogue {
    /// The files to be saved; `None` where a file is to be opened.
    outgoing: Option<Outgoing>,
    chosen: Chosen,
    begun: Instant,
}

/// A dialogue that ends sooner was never seen.
const SEEN: Duration = Duration::from_millis(200);

/// Files with the places where they are to be written.
struct Placed {
    files: Vec<(PathBuf, Vec<u8>)>,
    outgoing: Outgoing,
}

/// Files on the desktop.
pub struct Files {
    choose: Choose,
    wake: Wake,
    dialogue: Option<Dialogue>,
    /// What is written where the user agrees that files of others are replaced.
    asked: Option<Placed>,
    /// What the workbench has written itself.
    written: BTreeMap<PathBuf, Vec<u8>>,
    folder: Option<PathBuf>,
    events: Vec<Event>,
}

impl Files {
    /// With the dialogues of the system.
    pub fn new(wake: Wake) -> Self {
        Self {
            choose: Box::new(by_system),
            wake,
            dialogue: None,
            asked: None,
            written: BTreeMap::new(),
            folder: None,
            events: Vec::new(),
        }
    }

    /// Takes other dialogues than those of the system.
    pub fn choose_by(&mut self, choose: Choose) {
        self.choose = choose;
    }

    /// Asks for a file to be opened.
    pub fn open(&mut self) {
        self.show(&Choice::Open, None);
    }

    /// Gives files to the user: one at the path that a dialogue returns, several in a new folder within the one that is chosen.
    pub fn give(&mut self, outgoing: Outgoing) {
        let choice = outgoing.choice();
        self.show(&choice, Some(outgoing));
    }

    /// Writes a document to a path that it was saved to before, or opened from, and the files that it names into the same folder.
    pub fn save(&mut self, path: &Path, outgoing: Outgoing) {
        let placed = Placed::at(path, outgoing);
        self.write_unless_others(placed, None);
    }

    fn show(&mut self, choice: &Choice, outgoing: Option<Outgoing>) {
        self.dialogue = Some(Dialogue {
            outgoing,
            chosen: (self.choose)(choice, self.folder.as_deref()),
            begun: Instant::now(),
        });
    }

    /// What came of files since it was asked last.
    pub fn events(&mut self) -> Vec<Event> {
        if let Some(mut dialogue) = self.dialogue.take() {
            let waker = Waker::from(Arc::new(Woken(Arc::clone(&self.wake))));
            let mut context = task::Context::from_waker(&waker);
            match dialogue.chosen.as_mut().poll(&mut context) {
                Poll::Pending => self.dialogue = Some(dialogue),
                Poll::Ready(None) => self.events.push(dialogue.without_choice()),
                Poll::Ready(Some(path)) => self.take(path, dialogue.outgoing),
            }
        }
        std::mem::take(&mut self.events)
    }

    fn take(&mut self, path: PathBuf, outgoing: Option<Outgoing>) {
        let Some(outgoing) = outgoing else {
            self.folder = path.parent().map(Path::to_owned);
            self.events.push(Event::Chosen(path));
            return;
        };
        let Choice::Save(name) = outgoing.choice() else {
            let placed = Placed::within(&path, outgoing);
            self.folder = Some(path);
            return self.write_unless_others(placed, None);
        };
        self.folder = path.parent().map(Path::to_owned);
        // The dialogue has asked about the file that it returns, not about one with an ending more.
        match (path.extension(), Path::new(&name).extension()) {
            (None, Some(ending)) => {
                let placed = Placed::at(&path.with_extension(ending), outgoing);
                self.write_unless_others(placed, None);
            }
            _ => self.write_unless_others(Placed::at(&path, outgoing), Some(&path)),
        }
    }

    /// Writes files, or asks first where that replaces others than the one that the user has agreed to.
    fn write_unless_others(&mut self, placed: Placed, agreed: Option<&Path>) {
        let others = placed
            .files
            .iter()
            .any(|(path, content)| agreed != Some(path) && self.is_of_others(path, content));
        if others {
            self.asked = Some(placed);
        } else {
            self.write(placed);
        }
    }

    /// Whether a file exists whose contents are neither those to be written nor those that the workbench has written.
    fn is_of_others(&self, path: &Path, content: &[u8]) -> bool {
        match fs::read(path) {
            Ok(there) => there != content && self.written.get(path) != Some(&there),
            Err(fault) => fault.kind() != io::ErrorKind::NotFound,
        }
    }

    fn write(&mut self, placed: Placed) {
        let Placed { files, outgoing } = placed;
        let message = placed_in_words(&files, &outgoing);
        let first = files.first().map(|(path, _)| path.clone());
        for (path, content) in files {
            let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
            if let Err(cause) = folder.and_then(|()| fs::write(&path, &content)) {
                let fault = format!(
                    "cannot write {}: {cause}; `save as …` and `export` choose another folder",
                    path.display()
                );
                self.events.push(Event::Failed(fault));
                return;
            }
            self.written.insert(path, content);
        }
        self.events.push(Event::Saved {
            outgoing,
            path: first,
            message,
        });
    }

    /// Asks what must be answered; whether anything must.
    pub fn ask(&mut self, context: &Context) -> bool {
        let Some(placed) = self.asked.take() else {
            return false;
        };
        let names: Vec<String> = placed
            .files
            .iter()
            .filter(|(path, content)| self.is_of_others(path, content))
            .map(|(path, _)| path.display().to_string())
            .collect();
        let text = match &names[..] {
            [name] => format!(
                "{name} is there already, and this workbench has not written it as it is. Replace it?"
            ),
            _ => format!(
                "{} files are there already, and this workbench has not written them as they are, such as {}. Replace them?",
                names.len(),
                names.first().map_or("", String::as_str)
            ),
        };
        match question::ask(context, &text, &["replace", "save as …", "cancel"]) {
            None => self.asked = Some(placed),
            Some(0) => self.write(placed),
            Some(1) => self.give(placed.outgoing),
            Some(_) => self
                .events
                .push(Event::Failed("nothing was saved".to_owned())),
        }
        true
    }
}

impl Outgoing {
    /// The user names a document or a single file; several files without a document go into a folder.
    fn choice(&self) -> Choice {
        match &self.written.files[..] {
            [(name, _), others @ ..] if self.document.is_some() || others.is_empty() => {
                Choice::Save(name.clone())
            }
            _ => Choice::Folder(self.written.name.clone()),
        }
    }
}

impl Dialogue {
    fn without_choice(&self) -> Event {
        let message = if self.begun.elapsed() < SEEN {
            "the system shows no dialogue for files: xdg-desktop-portal or zenity is missing. Files can be dropped on the window"
        } else if self.outgoing.is_some() {
            "nothing was saved"
        } else {
            "nothing was opened"
        };
        Event::Failed(message.to_owned())
    }
}

impl Placed {
    /// The first file at a path, the others beside it.
    fn at(path: &Path, outgoing: Outgoing) -> Self {
        let others = outgoing.written.files.iter().enumerate();
        let position = |(number, (name, content)): (usize, &(String, Vec<u8>))| match number {
            0 => (path.to_owned(), content.clone()),
            _ => (path.with_file_name(name), content.clone()),
        };
        Self {
            files: others.map(position).collect(),
            outgoing,
        }
    }

    /// All files in a folder of their own within another one.
    fn within(folder: &Path, outgoing: Outgoing) -> Self {
        let folder = folder.join(&outgoing.written.name);
        let files = outgoing
            .written
            .files
            .iter()
            .map(|(name, content)| (folder.join(name), content.clone()))
            .collect();
        Self { files, outgoing }
    }
}

/// Where files are.
fn placed_in_words(files: &[(PathBuf, Vec<u8>)], outgoing: &Outgoing) -> String {
    match files {
        [(path, _)] => format!("saved as {}", path.display()),
        [(path, _), others @ ..] if outgoing.document.is_some() => {
            let others = others.iter().map(|(path, _)| path.display().to_string());
            format!(
                "saved as {}, with {} beside it",
                path.display(),
                others.collect::<Vec<_>>().join(", ")
            )
        }
        _ => {
            let folders = files.iter().filter_map(|(path, _)| path.parent());
            let folder = folders
                .min_by_key(|folder| folder.components().count())
                .map_or_else(String::new, |folder| folder.display().to_string());
            format!("{} files in {folder}", files.len())
        }
    }
}

/// The system's own dialogues.
fn by_system(choice: &Choice, folder: Option<&Path>) -> Chosen {
    let mut dialogue = AsyncFileDialog::new();
    if let Some(folder) = folder {
        dialogue = dialogue.set_directory(folder);
    }
    match choice {
        Choice::Open => {
            let file = dialogue
                .set_title("Open a study, a card, a test or a measured field")
                .pick_file();
            Box::pin(async { Some(file.await?.path().to_owned()) })
        }
        Choice::Save(name) => {
            let file = dialogue
                .set_title("Save as")
                .set_file_name(name)
                .save_file();
            Box::pin(async { Some(file.await?.path().to_owned()) })
        }
        Choice::Folder(name) => {
            let title = format!("Export into a folder, as {name}");
            let folder = dialogue.set_title(title).pick_folder();
            Box::pin(async { Some(folder.await?.path().to_owned()) })
        }
    }
}

/// Draws a frame when a dialogue ends.
struct Woken(Wake);

impl task::Wake for Woken {
    fn wake(self: Arc<Self>) {
        (self.0)();
    }
}
