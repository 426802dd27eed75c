//! The files that were opened or saved last.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that are remembered.
const REMEMBERED: usize = 10;

/// The files that were opened or saved last, the newest first; one a line in a file of the user's.
#[derive(Default)]
pub struct Recent {
    list: Option<PathBuf>,
    paths: Vec<PathBuf>,
}

impl Recent {
    /// Those of the user, where the system has a folder for what programs remember.
    pub fn of_user() -> Self {
        let set = |name: &str| {
            env::var_os(name)
                .filter(|value| !value.is_empty())
                .map(PathBuf::from)
        };
        let folder = match env::consts::OS {
            "windows" => set("APPDATA"),
            "macos" => set("HOME").map(|home| home.join("Library/Application Support")),
            _ => set("XDG_STATE_HOME").or_else(|| Some(set("HOME")?.join(".local/state"))),
        };
        folder.map_or_else(Self::default, |folder| {
            Self::in_list(folder.join("gelbench/recent"))
        })
    }

    /// Those that a list names.
    pub fn in_list(list: PathBuf) -> Self {
        let text = fs::read_to_string(&list).unwrap_or_default();
        let paths = text.lines().take(REMEMBERED).map(PathBuf::from).collect();
        Self {
            list: Some(list),
            paths,
        }
    }

    /// The files.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// Puts a file first.
    pub fn put(&mut self, path: &Path) {
        self.paths.retain(|known| known != path);
        self.paths.insert(0, path.to_owned());
        self.paths.truncate(REMEMBERED);
        self.write();
    }

    /// Forgets a file, such as one that is no longer there.
    pub fn forget(&mut self, path: &Path) {
        self.paths.retain(|known| known != path);
        self.write();
    }

    /// A list that cannot be written lasts as long as the program: nothing else depends on it.
    fn write(&self) {
        let Some(list) = &self.list else { return };
        let lines: String = self
            .paths
            .iter()
            .map(|path| format!("{}\n", path.display()))
            .collect();
        let folder = list.parent().map_or(Ok(()), fs::create_dir_all);
        let _ = folder.and_then(|()| fs::write(list, lines));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_files_come_first_and_are_there_the_next_time() {
        let folder = env::temp_dir().join(format!("gelbench-recent-{}", std::process::id()));
        let list = folder.join("deep/recent");
        let mut recent = Recent::in_list(list.clone());
        for number in 0..REMEMBERED + 2 {
            recent.put(&PathBuf::from(format!("/studies/{number}.toml")));
        }
        recent.put(Path::new("/studies/5.toml"));
        recent.forget(Path::new("/studies/11.toml"));
        let again = Recent::in_list(list);
        assert_eq!(again.paths().len(), REMEMBERED - 1);
        let first = ["/studies/5.toml", "/studies/10.toml"].map(PathBuf::from);
        assert_eq!(again.paths()[..2], first);
        fs::remove_dir_all(folder).unwrap();
    }
}
