//! The page: one file of well-formed markup that names nothing outside of itself.

use super::figures::Figure;
use super::findings::Findings;
use super::{machine, palette, summary};
use std::fmt::Write;

/// Markup with `{{names}}` in place of what is measured.
const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

pub(super) fn page(findings: &Findings<'_>, figures: &[Figure], commands: &[&str]) -> String {
    let command: Vec<String> = std::env::args().skip(1).collect();
    let lines: String = commands.iter().map(|line| format!("{}\n", escape(line.trim()))).collect();
    let filled = [
        ("style", format!("{STYLE}{}", palette::dark_style())),
        ("date", machine::date()),
        ("machine", escape(&machine::name())),
        ("backend", findings.backend.name().to_owned()),
        ("batch", findings.batch.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("command", escape(&format!("airlight {}", command.join(" ")))),
        ("commands", lines),
        ("answer", escape(&summary::answer(findings))),
        ("summary", summary::table(&findings.all)),
        ("overview", figures.iter().take(1).map(|figure| article(1, figure)).collect()),
        ("figures", figures.iter().enumerate().skip(1).map(|(i, figure)| article(i + 1, figure)).collect()),
    ];
    filled.into_iter().fold(PAGE.to_owned(), |page, (name, text)| page.replace(&format!("{{{{{name}}}}}"), &text))
}

fn article(number: usize, figure: &Figure) -> String {
    let mut markup =
        format!("<figure id=\"figure-{number}\">\n<h2>{number}. {}</h2>\n<div class=\"drawings\">\n", figure.title);
    for drawing in &figure.drawings {
        let (name, title) = (&drawing.name, escape(&drawing.title));
        let _ = writeln!(
            markup,
            "<div class=\"drawing\">{}\n{}\n<p class=\"files\"><a href=\"{name}.svg\">SVG</a> <a \
             href=\"{name}.png\">PNG</a></p></div>",
            if figure.drawings.len() > 1 { format!("<h3>{title}</h3>") } else { String::new() },
            drawing.svg()
        );
    }
    let _ = writeln!(markup, "</div>\n<figcaption>{}</figcaption>\n</figure>", escape(&figure.caption));
    markup
}

/// Text as markup.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
