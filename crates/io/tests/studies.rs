//! Studies that tests write.

use std::fmt::Write as _;

/// The text of a study, table by table.
#[derive(Debug, Clone)]
pub struct Study(String);

impl Study {
    /// A study with this base and kind of design, whose results are in the folder `results`; `keys` are more lines before all tables.
    pub fn new(base: &str, design: &str, keys: &str) -> Self {
        Self(format!("version = 1\nbase = \"{base}\"\ndesign = \"{design}\"\ndirectory = \"results\"\n{keys}\n"))
    }

    /// The same of experiments, whose response `y` is measured elsewhere: it has no base.
    pub fn lab(design: &str) -> Self {
        Self(format!("version = 1\ntitle = \"Lab\"\ndesign = \"{design}\"\ndirectory = \"results\"\n")).imported("y")
    }

    /// A table as it stands, such as `[replicates]`.
    pub fn table(mut self, lines: &str) -> Self {
        self.0 += lines;
        self.0 += "\n";
        self
    }

    /// A factor with these values, as `levels = [1, 2]`.
    pub fn factor(mut self, name: &str, key: &str, values: &str) -> Self {
        writeln!(self.0, "[[factor]]\nname = \"{name}\"\nkey = \"{key}\"\n{values}").expect("room for a text");
        self
    }

    /// The load as a factor.
    pub fn load(self, values: &str) -> Self {
        self.factor("load", "operation.normal_force", values)
    }

    /// The fibre fraction as a factor.
    pub fn fibres(self, values: &str) -> Self {
        self.factor("fibres", "pin.base.synthetic.fibre_fraction", values)
    }

    /// A response of a dataset of each run, as of `/series/pool` what `at = "end"` asks for.
    pub fn response(mut self, name: &str, dataset: &str, question: &str) -> Self {
        writeln!(self.0, "[[response]]\nname = \"{name}\"\ndataset = \"{dataset}\"\n{question}")
            .expect("room for a text");
        self
    }

    /// A response that is measured elsewhere.
    pub fn imported(self, name: &str) -> Self {
        self.table(&format!("[[response]]\nname = \"{name}\"\nimported = true"))
    }

    /// The text.
    pub fn text(self) -> String {
        self.0
    }
}

impl AsRef<[u8]> for Study {
    fn as_ref(&self) -> &[u8] {
        self.0.as_bytes()
    }
}
