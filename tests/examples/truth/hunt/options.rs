//! The options of a hunt.

/// The tolerances of a hunt that names no others.
const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Those for soft light.
const SOFT_TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The options of a hunt.
#[derive(Clone, Debug)]
pub(super) struct Options {
    pub(super) scenes: u64,
    pub(super) seed: u64,
    pub(super) family: String,
    pub(super) tolerances: Vec<f64>,
    pub(super) folder: Option<String>,
    pub(super) page: Option<String>,
    /// Scenes of each row of an array of features, where that is told.
    pub(super) rows: Option<u64>,
    /// The only scene of a family.
    pub(super) only: Option<u64>,
    /// The file of what may be given up.
    pub(super) limits: Option<String>,
}

impl Options {
    pub(super) fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            scenes: 160,
            seed: 1,
            family: String::new(),
            tolerances: TOLERANCES.to_vec(),
            folder: None,
            page: None,
            limits: None,
            only: None,
            rows: None,
        };
        for pair in arguments.chunks(2) {
            let [name, value] = pair else {
                return Err(format!("{} needs a value", pair[0]));
            };
            let number = || {
                value
                    .parse()
                    .map_err(|_| format!("{value} is not a number"))
            };
            match *name {
                "--scenes" => options.scenes = number()?,
                "--seed" => options.seed = number()?,
                "--family" => options.family = (*value).to_owned(),
                "--tolerances" => options.tolerances = tolerances(value)?,
                "--write" => options.folder = Some((*value).to_owned()),
                "--rows" => options.rows = Some(number()?),
                "--only" => options.only = Some(number()?),
                "--limits" => options.limits = Some((*value).to_owned()),
                "--page" => options.page = Some((*value).to_owned()),
                _ => return Err(format!("unknown option {name}")),
            }
        }
        Ok(options)
    }

    /// Takes the tolerances for soft light if no others are named.
    pub(super) fn limit_to_soft(&mut self) {
        if self.unusual_tolerances().is_none() {
            self.tolerances = SOFT_TOLERANCES.to_vec();
        }
    }

    /// The part of the page that these options write: each list of tolerances has one of its own.
    pub(super) fn part(&self) -> String {
        match self.unusual_tolerances() {
            Some(tolerances) => format!("hunt {tolerances}"),
            None => "hunt".to_owned(),
        }
    }

    /// The command that finds the same.
    pub(super) fn command(&self) -> String {
        let Self { scenes, seed, .. } = self;
        let mut command = format!("cargo truth hunt --scenes {scenes} --seed {seed}");
        if let Some(tolerances) = self.unusual_tolerances() {
            command += &format!(" --tolerances {tolerances}");
        }
        if !self.family.is_empty() {
            command += &format!(" --family '{}'", self.family);
        }
        if let Some(rows) = self.rows {
            command += &format!(" --rows {rows}");
        }
        command
    }

    /// The tolerances as they were asked for, if they are not the usual ones.
    fn unusual_tolerances(&self) -> Option<String> {
        let names: Vec<_> = self.tolerances.iter().map(|it| format!("{it:e}")).collect();
        (self.tolerances != TOLERANCES).then(|| names.join(","))
    }
}

fn tolerances(list: &str) -> Result<Vec<f64>, String> {
    let tolerance = |text: &str| {
        let tolerance = text.parse().ok();
        let tolerance = tolerance.filter(|it: &f64| it.is_finite() && *it > 0.0);
        tolerance.ok_or_else(|| format!("{text} is not a tolerance"))
    };
    list.split(',').map(tolerance).collect()
}
