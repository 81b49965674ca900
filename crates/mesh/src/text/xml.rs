/// Returns a text as the contents of an XML element, with its markup characters replaced.
pub fn xml_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
