//! The scene as a PNG, drawn larger and averaged down.
//!
//! kuva's rasteriser leaves the edges of thick lines and of rotated text hard; drawn
//! several times larger, the average of the finer pixels is the soft edge.

use std::io::Cursor;

use kuva::RasterBackend;
use kuva::render::render::Scene;

/// Finer pixels across one pixel of the image, at most.
const FINENESS: u32 = 3;
/// Most finer pixels in all: bounds memory, at four bytes each.
const MOST_PIXELS: u64 = 32 << 20;
/// Red, green, blue, opacity: kuva's order.
const CHANNELS: usize = 4;

/// Draws a scene as a PNG file of `width` × `height` pixels.
pub(super) fn render(scene: &Scene, width: u32, height: u32) -> Result<Vec<u8>, String> {
    let fineness = fineness(width, height);
    let fine = RasterBackend::new()
        .with_scale(fineness as f32)
        .render_scene(scene)?;
    let pixels = decode(&fine, width * fineness, height * fineness)?;
    encode(&average(&pixels, width, fineness), width, height)
}

fn fineness(width: u32, height: u32) -> u32 {
    let pixels = u64::from(width) * u64::from(height);
    let fits = |fineness: &u32| pixels * u64::from(fineness.pow(2)) <= MOST_PIXELS;
    (1..=FINENESS).rev().find(fits).unwrap_or(1)
}

fn decode(file: &[u8], width: u32, height: u32) -> Result<Vec<u8>, String> {
    let decoder = png::Decoder::new(Cursor::new(file));
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let info = reader.info();
    if (info.width, info.height, info.color_type) != (width, height, png::ColorType::Rgba) {
        return Err("the drawn image has another size or colour format than asked for".to_owned());
    }
    let size = reader
        .output_buffer_size()
        .ok_or("the image is too large")?;
    let mut pixels = vec![0; size];
    reader
        .next_frame(&mut pixels)
        .map_err(|error| error.to_string())?;
    Ok(pixels)
}

/// Means of squares of `fineness` pixels, as red, green, blue: the picture is opaque.
fn average(pixels: &[u8], width: u32, fineness: u32) -> Vec<u8> {
    let (width, fineness) = (width as usize, fineness as usize);
    let fine_row = width * fineness * CHANNELS;
    let count = (fineness * fineness) as u32;
    let mut out = Vec::with_capacity(pixels.len() / fineness / fineness);
    let mut sums = vec![[0_u32; 3]; width];
    for band in pixels.chunks_exact(fine_row * fineness) {
        sums.fill([0; 3]);
        for row in band.chunks_exact(fine_row) {
            let squares = row.chunks_exact(fineness * CHANNELS);
            for (sum, square) in sums.iter_mut().zip(squares) {
                for pixel in square.chunks_exact(CHANNELS) {
                    for (total, &channel) in sum.iter_mut().zip(pixel) {
                        *total += u32::from(channel);
                    }
                }
            }
        }
        let means = sums.iter().flatten().map(|sum| (sum + count / 2) / count);
        out.extend(means.map(|mean| mean as u8));
    }
    out
}

fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, String> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer
        .write_image_data(pixels)
        .map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())?;
    Ok(file)
}
