//! The Markdown of the manual as blocks to draw.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

/// A piece of running text in one style.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// The text, without markup.
    pub text: String,
    /// Semi-bold: strong text and emphasis.
    pub strong: bool,
    /// Monospaced.
    pub code: bool,
    /// The target of the link, as written in the file.
    pub link: Option<String>,
}

/// A paragraph, a picture, a table and so on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// A heading with its depth, from 1.
    Heading(usize, Vec<Span>),
    /// Running text.
    Paragraph(Vec<Span>),
    /// An entry of a list: how deep it is nested from 1, its bullet or number, its text.
    Item(usize, String, Vec<Span>),
    /// Lines as they are.
    Code(String),
    /// Rows of cells, the header first.
    Table(Vec<Vec<Vec<Span>>>),
    /// A picture: its file as written, and its description.
    Picture(String, String),
}

/// Returns the blocks of a page.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut reader = Reader::default();
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        reader.take(event);
    }
    reader.blocks
}

#[derive(Default)]
struct Reader {
    blocks: Vec<Block>,
    /// The text of the current block or cell.
    spans: Vec<Span>,
    /// The style of the text that follows.
    style: Span,
    /// The next number of each open list; `None` for bullets.
    lists: Vec<Option<u64>>,
    rows: Vec<Vec<Vec<Span>>>,
    /// The file of the picture whose description is being read.
    picture: Option<String>,
    is_code: bool,
}

impl Reader {
    fn take(&mut self, event: Event<'_>) {
        match event {
            Event::Start(tag) => self.start(tag),
            Event::End(tag) => self.end(tag),
            Event::Text(text) => self.text(&text),
            Event::Code(text) => {
                let style = Span { code: true, ..self.style.clone() };
                self.spans.push(Span { text: text.to_string(), ..style });
            }
            Event::SoftBreak | Event::HardBreak => self.text(" "),
            _ => {}
        }
    }

    fn text(&mut self, text: &str) {
        self.spans.push(Span { text: text.to_owned(), ..self.style.clone() });
    }

    fn start(&mut self, tag: Tag<'_>) {
        match tag {
            Tag::Strong | Tag::Emphasis => self.style.strong = true,
            Tag::Link { dest_url, .. } => self.style.link = Some(dest_url.to_string()),
            Tag::Image { dest_url, .. } => self.picture = Some(dest_url.to_string()),
            Tag::List(first) => {
                self.end_item();
                self.lists.push(first);
            }
            Tag::CodeBlock(kind) => self.is_code = matches!(kind, CodeBlockKind::Fenced(_)),
            Tag::TableHead | Tag::TableRow => self.rows.push(Vec::new()),
            _ => {}
        }
    }

    fn end(&mut self, tag: TagEnd) {
        match tag {
            TagEnd::Strong | TagEnd::Emphasis => self.style.strong = false,
            TagEnd::Link => self.style.link = None,
            TagEnd::Image => {
                let description = plain(&std::mem::take(&mut self.spans));
                self.blocks.extend(self.picture.take().map(|file| Block::Picture(file, description)));
            }
            TagEnd::Heading(level) => self.finish(|spans| Block::Heading(level as usize, spans)),
            TagEnd::Paragraph if self.lists.is_empty() => self.finish(Block::Paragraph),
            TagEnd::Item => self.end_item(),
            TagEnd::List(_) => drop(self.lists.pop()),
            TagEnd::CodeBlock => {
                let text = plain(&std::mem::take(&mut self.spans));
                self.blocks.push(Block::Code(text.trim_end().to_owned()));
            }
            TagEnd::TableCell => {
                let cell = std::mem::take(&mut self.spans);
                if let Some(row) = self.rows.last_mut() {
                    row.push(cell);
                }
            }
            TagEnd::Table => self.blocks.push(Block::Table(std::mem::take(&mut self.rows))),
            _ => {}
        }
    }

    /// Ends the text of an entry, at its own end or before a list within it.
    fn end_item(&mut self) {
        let depth = self.lists.len();
        if self.spans.is_empty() || depth == 0 {
            return;
        }
        let mark = match &mut self.lists[depth - 1] {
            Some(number) => {
                *number += 1;
                format!("{}.", *number - 1)
            }
            None => "•".to_owned(),
        };
        self.finish(|spans| Block::Item(depth, mark, spans));
    }

    fn finish(&mut self, block: impl FnOnce(Vec<Span>) -> Block) {
        let spans = std::mem::take(&mut self.spans);
        if !spans.is_empty() {
            self.blocks.push(block(spans));
        }
    }
}

/// Returns the text without its styles.
pub fn plain(spans: &[Span]) -> String {
    spans.iter().map(|span| span.text.as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Span {
        Span { text: text.to_owned(), ..Span::default() }
    }

    #[test]
    fn text_keeps_its_styles_and_links() {
        let strong = Span { strong: true, ..words("brush") };
        let code = Span { code: true, ..words("B") };
        let link = Span { link: Some("painting.md".into()), ..words("paint") };
        let expected =
            vec![words("The "), strong, words(" "), code, words(" can"), words(" "), link, words(".")];
        assert_eq!(
            blocks("The **brush** `B` can\n[paint](painting.md)."),
            [Block::Paragraph(expected)],
            "a line break in a paragraph is a space"
        );
    }

    #[test]
    fn lists_have_numbers_bullets_and_depths() {
        let item = |depth, mark: &str, text| Block::Item(depth, mark.into(), vec![words(text)]);
        let expected =
            [item(1, "1.", "one"), item(1, "2.", "two"), item(2, "•", "deeper"), item(1, "3.", "three")];
        assert_eq!(blocks("1. one\n2. two\n   - deeper\n3. three"), expected);
    }

    #[test]
    fn headings_code_tables_and_pictures_are_blocks() {
        let text = "# Title\n\n```text\na  b\nc\n```\n\n| x | y |\n|---|---|\n| 1 | `2` |\n\n![What it shows](pictures/a.png)";
        let [heading, code, table, picture] = &blocks(text)[..] else { panic!("{:?}", blocks(text)) };
        assert_eq!(*heading, Block::Heading(1, vec![words("Title")]));
        assert_eq!(*code, Block::Code("a  b\nc".into()));
        let Block::Table(rows) = table else { panic!("{table:?}") };
        assert_eq!((rows.len(), plain(&rows[1][1])), (2, "2".to_owned()));
        assert_eq!(*picture, Block::Picture("pictures/a.png".into(), "What it shows".into()));
    }
}
