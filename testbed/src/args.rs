//! The command line.

use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
The scenes of the physics engine, in a window or without one.

usage: testbed [options]

  --headless      no window: run the scenes one after the other, print a table, draw pictures
  --window        the window in this process, whether it can open or not
  --scene NAME    only scenes of that name, 2D and 3D; NAME may also be 2d/NAME, 3d/NAME, 2d or 3d
  --steps N       run N steps of 1/60 s instead of each scene's own number
  --out DIR       where to write the pictures (default: out)
  --idle          measure worlds in which nothing moves, and exit
  --list          print the scenes
  --help          print this

Without --headless and --window a window opens in a process of its own, if there is an X11 display and a Vulkan
driver; if it ends before it has drawn, the scenes run headless. In the window:

  up, down        choose a scene (or click on it)     space    pause, go on
  enter, r        start again                         s        a single step, when paused
  left drag       turn around                         wheel    nearer, farther
  right drag      shift                               home     camera to its first place
";

/// What the user asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Args {
    /// Never open a window.
    pub headless: bool,
    /// Open the window in this process, without probing first.
    pub window: bool,
    /// Run only matching scenes; see [`Args::selects`].
    pub scene: Option<String>,
    /// Number of steps, instead of each scene's own.
    pub steps: Option<u32>,
    /// Folder for pictures.
    pub out: PathBuf,
    /// Only measure idle worlds.
    pub idle: bool,
    /// Only print the scenes.
    pub list: bool,
    /// Only print the help.
    pub help: bool,
}

impl Default for Args {
    fn default() -> Self {
        Self {
            headless: false,
            window: false,
            scene: None,
            steps: None,
            out: PathBuf::from("out"),
            idle: false,
            list: false,
            help: false,
        }
    }
}

impl Args {
    /// Parses the arguments after the program's name. `Err` is a message for the user.
    pub fn parse(words: impl IntoIterator<Item = String>) -> Result<Self, String> {
        let mut args = Self::default();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let (option, inline) = match word.split_once('=') {
                Some((option, value)) => (option.to_owned(), Some(value.to_owned())),
                None => (word, None),
            };
            let mut value = || {
                let given = inline.clone().or_else(|| words.next());
                given.ok_or_else(|| format!("{option} needs a value"))
            };
            match option.as_str() {
                "--headless" => args.headless = true,
                "--window" => args.window = true,
                "--idle" => args.idle = true,
                "--list" => args.list = true,
                "--help" | "-h" => args.help = true,
                "--scene" => args.scene = Some(value()?),
                "--out" => args.out = PathBuf::from(value()?),
                "--steps" => {
                    let text = value()?;
                    let number =
                        text.parse().map_err(|_| format!("--steps {text}: not a number of steps"))?;
                    args.steps = Some(number);
                }
                _ => return Err(format!("unknown option {option}")),
            }
        }
        Ok(args)
    }

    /// Whether a scene is selected.
    pub fn selects(&self, dimension: u32, name: &str) -> bool {
        match self.scene.as_deref() {
            None => true,
            Some("2d") => dimension == 2,
            Some("3d") => dimension == 3,
            Some(wanted) => match wanted.split_once('/') {
                Some((prefix, wanted)) => prefix == format!("{dimension}d") && wanted == name,
                None => wanted == name,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Args, String> {
        Args::parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn options_are_understood_in_both_spellings() {
        let args = parse("--headless --scene=3d/tumbler --steps 20 --out pictures").unwrap();
        assert!(args.headless && !args.window && !args.list);
        assert_eq!(args.steps, Some(20));
        assert_eq!(args.out, PathBuf::from("pictures"));
        assert!(args.selects(3, "tumbler") && !args.selects(2, "tumbler") && !args.selects(3, "towers"));
        assert!(parse("--scene towers").unwrap().selects(2, "towers"));
        assert!(parse("--scene 2d").unwrap().selects(2, "dominoes"));
        assert!(parse("--window").unwrap().window);
        assert_eq!(parse("").unwrap(), Args::default());
    }

    #[test]
    fn mistakes_are_named() {
        assert!(parse("--steps").unwrap_err().contains("needs a value"));
        assert!(parse("--steps many").unwrap_err().contains("many"));
        assert!(parse("--frobnicate").unwrap_err().contains("--frobnicate"));
    }
}
