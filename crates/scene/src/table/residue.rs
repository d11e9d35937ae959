//! The elements that names of atoms tell, as the residues that they belong to have them.
//!
//! # Source
//! The Protein Data Bank's dictionary of chemical components; the manuals of GROMACS, AMBER and CHARMM for the names that
//! force fields give to residues and ions.

use super::element::{of_plain_symbol, of_symbol};

/// Residues of proteins and nucleic acids, and water: their atoms are hydrogen, carbon, nitrogen, oxygen, phosphorus,
/// sulfur and selenium.
const STANDARD: &str = "ALA ARG ASN ASP CYS GLN GLU GLY HIS ILE LEU LYS MET PHE PRO SER THR TRP TYR VAL \
     MSE SEC PYL ASX GLX UNK ACE NME NMA NH2 FOR \
     ASH CYM CYX GLH HID HIE HIP HSD HSE HSP LYN ARN TYM HYP SEP TPO PTR \
     CYS1 CYS2 CYSH HISA HISB HISD HISE HISH HIS1 HIS2 ASPH GLUH LYSH ARGN \
     A C G U I T N DA DC DG DT DU DI DN RA RC RG RU ADE CYT GUA URA THY \
     A3 A5 C3 C5 G3 G5 U3 U5 DA3 DA5 DC3 DC5 DG3 DG5 DT3 DT5 RA3 RA5 RC3 RC5 RG3 RG5 RU3 RU5 \
     HOH DOD WAT SOL H2O TIP TIP3 TIP4 TIP5 TIP3P TIP4P SPC TP3 TP4";

/// Ions that force fields call by other names than their symbols.
const IONS: [(&[u8], &[u8]); 10] = [
    (b"SOD", b"NA"),
    (b"POT", b"K"),
    (b"CLA", b"CL"),
    (b"CAL", b"CA"),
    (b"CES", b"CS"),
    (b"LIT", b"LI"),
    (b"RUB", b"RB"),
    (b"BAR", b"BA"),
    (b"CAD", b"CD"),
    (b"CIO", b"CS"),
];

/// The atomic number of a type of AutoDock's: elements, some of them with what their atoms do.
pub(crate) fn of_docking_type(kind: &[u8]) -> Option<u8> {
    match &*kind.to_ascii_uppercase() {
        b"A" => of_symbol(b"C"),
        b"HD" | b"HS" => of_symbol(b"H"),
        b"NA" | b"NS" => of_symbol(b"N"),
        b"OA" | b"OS" => of_symbol(b"O"),
        b"SA" => of_symbol(b"S"),
        kind => of_symbol(kind),
    }
}

/// Says whether the atoms of a residue are those of proteins, nucleic acids or water.
pub(crate) fn is_standard(residue: &[u8]) -> bool {
    let residue = residue.trim_ascii();
    // Residues at the ends of a chain have a letter before them.
    let inner = match residue {
        [b'N' | b'C', inner @ ..] if inner.len() == 3 => inner,
        _ => residue,
    };
    let mut known = STANDARD.split(' ').map(str::as_bytes);
    known.any(|known| known.eq_ignore_ascii_case(residue) || known.eq_ignore_ascii_case(inner))
}

/// The atomic number that a name in the four columns of PDB tells, in which symbols of one letter begin at the second.
///
/// If all names of a file begin at the first column, only [`of_atom`] tells them.
pub(crate) fn of_aligned_atom(name: &[u8], residue: &[u8]) -> Option<u8> {
    let by_place = match name {
        [first, second, _, b' '] if first.is_ascii_alphabetic() && second.is_ascii_alphabetic() => {
            of_symbol(&name[..2])
        }
        _ => None,
    };
    let is_special = is_standard(residue) || ion(name.trim_ascii(), residue).is_some();
    by_place
        .filter(|_| !is_special)
        .or_else(|| of_atom(name, residue))
}

/// The atomic number of an ion that is a residue by itself.
fn ion(name: &[u8], residue: &[u8]) -> Option<u8> {
    if !name.eq_ignore_ascii_case(residue.trim_ascii()) {
        return None;
    }
    let mut ions = IONS.iter();
    let (_, symbol) = ions.find(|(ion, _)| ion.eq_ignore_ascii_case(name))?;
    of_symbol(symbol)
}

/// The atomic number that the name of an atom in a residue tells, as force fields write it: the symbol first, and
/// what distinguishes it from others behind, so that `CA` is carbon unless the residue is called so, too.
pub(crate) fn of_atom(name: &[u8], residue: &[u8]) -> Option<u8> {
    let name = name.trim_ascii();
    let digits = name.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let name = &name[digits..];
    let letters = |text: &[u8]| {
        let letters = text.iter().take_while(|byte| byte.is_ascii_alphabetic());
        letters.map(u8::to_ascii_uppercase).collect::<Vec<u8>>()
    };
    if is_standard(residue) {
        return of_standard(&letters(name));
    }
    if let Some(ion) = ion(name, residue) {
        return Some(ion);
    }
    let (name, residue) = (letters(name), letters(residue.trim_ascii()));
    if name == residue && name.len() <= 2 {
        return of_plain_symbol(&name);
    }
    /// Symbols of two letters that no usual name of hydrogen, carbon, nitrogen and the like begins with; of metals
    /// nothing but a number follows, for other names begin so, too: `MNH1` is no manganese.
    const LONG: [&[u8]; 3] = [b"CL", b"BR", b"SI"];
    const METALS: [&[u8]; 7] = [b"FE", b"ZN", b"MG", b"MN", b"LI", b"CU", b"RB"];
    let start = name.get(..2).unwrap_or(&name);
    if LONG.contains(&start) || METALS.contains(&&*name) {
        return of_symbol(start);
    }
    // Beads of coarse models begin with other letters, too.
    let first = name.first().filter(|letter| b"HCNOSPFI".contains(letter))?;
    of_symbol(&[*first])
}

/// The same in a residue of proteins, nucleic acids or water: there is no metal in them.
fn of_standard(name: &[u8]) -> Option<u8> {
    match name {
        [b'S', b'E', ..] => of_symbol(b"SE"),
        // `SC1` is a bead of a coarse model.
        [b'S'] | [b'S', b'D' | b'G', ..] => of_symbol(b"S"),
        [first @ (b'H' | b'D' | b'C' | b'N' | b'O' | b'P'), ..] => of_symbol(&[*first]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::element::symbol;
    use super::*;

    #[test]
    fn names_in_standard_residues_are_no_metals() {
        for (name, residue, expected) in [
            ("CA", "ALA", Some("C")),
            ("CA", "CA", Some("Ca")),
            ("HG1", "THR", Some("H")),
            ("HG", "HG", Some("Hg")),
            ("CD1", "ILE", Some("C")),
            ("CD", "CD", Some("Cd")),
            ("NE2", "HSD", Some("N")),
            ("HE21", "GLN", Some("H")),
            ("1HB", "NALA", Some("H")),
            ("SE", "MSE", Some("Se")),
            ("SD", "MET", Some("S")),
            ("SC1", "LYS", None),
            ("OP1", "DA5", Some("O")),
            ("P", "DA", Some("P")),
            ("DG", "SER", Some("H")),
            ("OW", "SOL", Some("O")),
            ("HW1", "SOL", Some("H")),
            ("MW", "SOL", None),
            ("SOD", "SOD", Some("Na")),
            ("CLA", "CLA", Some("Cl")),
            ("CL", "CL", Some("Cl")),
            ("NA+", "NA+", Some("Na")),
            ("CL1", "LIG", Some("Cl")),
            ("FE", "HEM", Some("Fe")),
            ("MNH1", "VS", None),
            ("BB", "POPC", None),
        ] {
            let found = of_atom(name.as_bytes(), residue.as_bytes());
            assert_eq!(found.and_then(symbol), expected, "{name} {residue}");
        }
    }
}
