//! Files of other kinds, which are no tables or are not read as such: what they are, and a way to make a table of them.

mod kinds;
mod texts;

pub(crate) use self::kinds::Foreign;
use self::kinds::KINDS;

/// The kind of files whose names end so.
pub(super) fn by_ending(ending: &str) -> Option<&'static Foreign> {
    KINDS.iter().find(|kind| kind.endings.contains(&ending))
}

/// The kind of a file that begins so, where that is sure.
pub(super) fn by_contents(head: &[u8]) -> Option<&'static Foreign> {
    let starts =
        |(at, magic): &(usize, &[u8])| head.get(*at..).is_some_and(|rest| rest.starts_with(magic));
    let by_magic = KINDS.iter().find(|kind| kind.magic.iter().any(starts));
    if by_magic.is_some() {
        return by_magic;
    }
    if is_sheet(head) {
        return by_ending("xlsx");
    }
    by_ending(texts::ending(head)?)
}

/// Says whether an archive is a sheet: those of arrays begin with one.
pub(super) fn is_sheet(head: &[u8]) -> bool {
    let name = head.get(30..).unwrap_or_default();
    head.starts_with(b"PK\x03\x04")
        && [
            &b"[Content_Types]"[..],
            b"_rels",
            b"xl/",
            b"docProps",
            b"mimetype",
        ]
        .iter()
        .any(|start| name.starts_with(start))
}

/// Says whether a text is a CIF, before whose data comments may stand.
pub(super) fn is_cif(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    first.is_some_and(|line| {
        line.get(..5)
            .is_some_and(|start| start.eq_ignore_ascii_case(b"data_"))
    })
}
