//! Reads a plot back: elements of an SVG document, pixels of a PNG.

use std::io::Cursor;

use leadscrew_host::plot::Figure;

/// A line of text in an SVG.
#[derive(Debug)]
pub struct Text {
    pub content: String,
    pub x: f64,
    pub size: f64,
    /// Whether it is centred on `x`, as labels beneath an axis are.
    pub middle: bool,
}

/// Start tags of one kind of element, attributes included.
pub fn elements<'a>(document: &'a str, name: &str) -> Vec<&'a str> {
    let open = format!("<{name} ");
    let tags = document.match_indices(&open);
    tags.map(|(start, _)| &document[start..])
        .map(|rest| &rest[..rest.find('>').expect("a start tag ends")])
        .collect()
}

/// A numeric attribute of a start tag.
pub fn number(tag: &str, attribute: &str) -> f64 {
    let open = format!(" {attribute}=\"");
    let start = tag.find(&open).expect("the attribute is there") + open.len();
    let value = tag[start..].split('"').next().expect("the value ends");
    value.parse().expect("the value is a number")
}

/// All text of a document.
pub fn texts(document: &str) -> Vec<Text> {
    let bodies = document.split("<text ").skip(1);
    bodies
        .map(|rest| {
            let (tag, rest) = rest.split_once('>').expect("a start tag ends");
            let tag = format!(" {tag}");
            Text {
                content: rest.split('<').next().unwrap_or_default().to_owned(),
                x: number(&tag, "x"),
                size: number(&tag, "font-size"),
                middle: tag.contains("\"middle\"") && !tag.contains("rotate"),
            }
        })
        .collect()
}

/// A decoded PNG.
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pixels: Vec<u8>,
}

impl Picture {
    pub fn of(figure: &Figure) -> Self {
        let file = figure.to_png().expect("the figure can be drawn");
        let mut reader = png::Decoder::new(Cursor::new(file))
            .read_info()
            .expect("the file is a PNG");
        let size = reader
            .output_buffer_size()
            .expect("the picture fits in memory");
        let mut pixels = vec![0; size];
        let info = reader
            .next_frame(&mut pixels)
            .expect("the picture is whole");
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self {
            width: info.width as usize,
            height: info.height as usize,
            pixels,
        }
    }

    /// Red, green and blue of a pixel.
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let start = (y * self.width + x) * 3;
        [0, 1, 2].map(|channel| self.pixels[start + channel])
    }

    /// Whether a pixel is of nearly this colour.
    pub fn near(&self, x: usize, y: usize, colour: [u8; 3]) -> bool {
        let near = |(a, b): (u8, u8)| a.abs_diff(b) < 60;
        self.at(x, y).into_iter().zip(colour).all(near)
    }
}
