//! Series as primitives of the target image.

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene};

use super::series::{Colour, Series, Stroke};
use super::stroke::{self, Pixel};
use super::{axis, decimate};

/// The image being made. kuva's two backends take the same scene, but a line costs
/// several times fewer bytes as our own SVG path, and its PNG dashes start anew at
/// every point, which makes a dense dashed line solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    Svg,
    Png,
}

/// Where a panel lies in the image, and how its axes map to it.
pub(super) struct Frame<M> {
    /// Edges, pixels.
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    /// From units of the axes to pixels.
    pub map: M,
}

/// Line or dots of one look, in the pixels of the image.
pub(super) struct Ink {
    pub colour: Colour,
    pub stroke: Stroke,
    pub width: f64,
}

impl Ink {
    pub fn of(series: &Series) -> Self {
        Self {
            colour: series.colour,
            stroke: series.stroke,
            width: series.drawn_width(),
        }
    }

    /// Length and gap of dashes, pixels. Round ends lengthen one and shorten the other
    /// by the width, so what is seen is about two to one.
    fn dash(&self) -> f64 {
        3.6 * self.width.max(1.2)
    }

    /// Draws lines, or dots at their points.
    pub fn draw(&self, scene: &mut Scene, target: Target, lines: Vec<Vec<Pixel>>) {
        match (target, self.stroke) {
            (Target::Svg, Stroke::Dots) => {
                let dots: Vec<Vec<Pixel>> = lines
                    .into_iter()
                    .flatten()
                    .map(|dot| vec![dot, dot])
                    .collect();
                self.svg(scene, &dots, None);
            }
            (Target::Svg, Stroke::Solid) => self.svg(scene, &lines, None),
            (Target::Svg, Stroke::Dashed) => {
                let dash = self.dash();
                self.svg(scene, &lines, Some(format!("{dash:.2}")));
            }
            (Target::Png, Stroke::Dots) => self.png_dots(scene, lines),
            (Target::Png, Stroke::Solid) => self.png(scene, lines),
            (Target::Png, Stroke::Dashed) => {
                let dash = self.dash();
                let cut = |line: &Vec<Pixel>| stroke::dashes(line, dash, dash);
                self.png(scene, lines.iter().flat_map(cut).collect());
            }
        }
    }

    fn svg(&self, scene: &mut Scene, lines: &[Vec<Pixel>], dasharray: Option<String>) {
        if lines.is_empty() {
            return;
        }
        scene.add(Primitive::Path(Box::new(PathData {
            d: stroke::svg_path(lines),
            fill: None,
            stroke: self.color(),
            stroke_width: self.width,
            opacity: None,
            stroke_dasharray: dasharray,
        })));
    }

    fn png(&self, scene: &mut Scene, lines: Vec<Vec<Pixel>>) {
        for points in lines {
            scene.add(Primitive::PolyLine {
                points,
                stroke: self.color(),
                stroke_width: self.width,
                stroke_dasharray: None,
            });
        }
    }

    fn png_dots(&self, scene: &mut Scene, dots: Vec<Vec<Pixel>>) {
        let (cx, cy) = dots.into_iter().flatten().unzip();
        scene.add(Primitive::CircleBatch {
            cx,
            cy,
            r: self.width / 2.0,
            fill: self.color(),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    fn color(&self) -> Color {
        let (red, green, blue) = self.colour.rgb();
        Color::Rgb(red, green, blue)
    }
}

/// Draws a series into its panel, thinned to what its pixels can show.
pub(super) fn series<M>(scene: &mut Scene, target: Target, frame: &Frame<M>, series: &Series)
where
    M: Fn((f64, f64)) -> Pixel,
{
    let columns = (frame.right - frame.left).ceil().max(1.0) as usize;
    let lines = match series.stroke {
        Stroke::Dots => vec![dots(frame, series, columns)],
        Stroke::Solid | Stroke::Dashed => decimate(&series.points, columns)
            .into_iter()
            .flat_map(|run| {
                let pixels: Vec<Pixel> = run.into_iter().map(&frame.map).collect();
                stroke::clip(&pixels, frame.top, frame.bottom)
            })
            .collect(),
    };
    Ink::of(series).draw(scene, target, lines);
}

/// Dots that can be told apart; where they are still too many, the envelope and samples
/// of what lies within.
fn dots<M>(frame: &Frame<M>, series: &Series, columns: usize) -> Vec<Pixel>
where
    M: Fn((f64, f64)) -> Pixel,
{
    /// Finer than pixels: a cloud of dots needs more of them than a line to look as dense.
    const PARTS_OF_COLUMN: usize = 4;
    let drawable = |point: &&(f64, f64)| axis::is_drawable(point.0) && axis::is_drawable(point.1);
    let pixels = series
        .points
        .iter()
        .filter(drawable)
        .map(|&point| (frame.map)(point))
        .filter(|pixel| (frame.top..=frame.bottom).contains(&pixel.1));
    let distinct = stroke::distinct(pixels, series.drawn_width());
    decimate(&distinct, columns * PARTS_OF_COLUMN).concat()
}
