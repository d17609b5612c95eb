//! From measured errors to the image of a map. Outside the tick, and free to take its time.

use super::error::EncodeError;
use super::format::{CRC, HEADER, MAGIC, STEP_BITS, VERSION, checked_edges, image_len};
use super::{
    BASE_FRAC, BASE_SPACING, BYTE_ZERO, ERROR_FRAC, EXACT_FRAC, EncoderMap, Form, PHASE_FRAC,
    Residual,
};

/// What is to go into a map. Edges are numbered from the zero boundary on: see [`super::tie`].
#[derive(Clone, Copy)]
pub struct MapContent<'c> {
    /// Edges of a revolution.
    pub edges: u32,
    /// Error of an edge, all its parts together, the mean of both directions, Q.16 d. A constant in it does not
    /// matter. Asked for several times an edge; always the same answer.
    pub error: &'c dyn Fn(u32) -> i32,
    /// Mean error of the edges 0, 1, 2, 3 of all lines, forward and backward, Q.16 d.
    pub phases: [[i32; 4]; 2],
    /// Count that the index latches less that of the zero boundary, forward and backward, where known.
    pub fronts: [Option<i16>; 2],
    /// What is left.
    pub residual: Residual,
}

/// Writes the image of a map to the beginning of `out` and returns its length: [`image_len`].
///
/// The base is the mean over 64 edges about each of its entries; the step of the bytes is the finest that
/// holds what is left.
///
/// # Errors
/// [`EncodeError`]; `out` is then no map.
pub fn encode(content: &MapContent<'_>, form: Form, out: &mut [u8]) -> Result<usize, EncodeError> {
    let edges = content.edges;
    if checked_edges(edges).is_none() {
        return Err(EncodeError::Edges { edges });
    }
    let (given, needed) = (out.len(), image_len(edges, form));
    let memory = EncodeError::Memory { given, needed };
    let image = out.get_mut(..needed).ok_or(memory)?;
    let phases = quantised_phases(&content.phases)?;
    let rest = Rest { content, phases };

    let (header, body) = image.split_at_mut_checked(HEADER).ok_or(memory)?;
    let (base, body) = body
        .split_at_mut_checked(form.base_entries(edges).wrapping_mul(2))
        .ok_or(memory)?;
    let (base, _) = base.as_chunks_mut();
    write_base(&rest, base)?;
    let step_bits = match form {
        Form::Full => write_bytes(&rest, base, body)?,
        Form::Coarse | Form::Phases => STEP_BITS.1,
    };
    write_header(content, &phases, form, step_bits, header).ok_or(memory)?;
    let (written, checksum) = image.split_last_chunk_mut().ok_or(memory)?;
    *checksum = CRC.checksum(written).to_le_bytes();
    match EncoderMap::from_bytes(image) {
        Ok(_) => Ok(needed),
        Err(_) => Err(EncodeError::Figure),
    }
}

fn quantised_phases(phases: &[[i32; 4]; 2]) -> Result<[[i16; 4]; 2], EncodeError> {
    const BITS: u32 = ERROR_FRAC - PHASE_FRAC;
    let mut quantised = [[0; 4]; 2];
    let all = quantised.iter_mut().flatten();
    for (quantised, &error) in all.zip(phases.iter().flatten()) {
        let rounded = error.saturating_add(1 << (BITS - 1)).wrapping_shr(BITS);
        *quantised = i16::try_from(rounded).map_err(|_| EncodeError::Phase { error })?;
    }
    Ok(quantised)
}

/// The errors less the phases as they are written, so that the bytes take up their rounding.
struct Rest<'c> {
    content: &'c MapContent<'c>,
    phases: [[i16; 4]; 2],
}

impl Rest<'_> {
    /// Of an edge, units of [`EXACT_FRAC`].
    fn of(&self, edge: u32) -> i64 {
        let both = self.phases.iter().fold(0_i64, |sum, phases| {
            let phase = phases.get((edge & 3) as usize);
            sum.wrapping_add(i64::from(phase.copied().unwrap_or(0)))
        });
        // The mean of the directions.
        let phase = both.wrapping_shl(EXACT_FRAC - PHASE_FRAC - 1);
        i64::from((self.content.error)(edge))
            .wrapping_shl(EXACT_FRAC - ERROR_FRAC)
            .wrapping_sub(phase)
    }

    /// Mean of 64 edges about one, the two at the ends for half each; round the revolution, several times if it
    /// is shorter.
    fn smooth(&self, edge: u32) -> i64 {
        const HALF: u32 = BASE_SPACING / 2;
        let edges = self.content.edges;
        // Whole revolutions keep it from going below zero; of 64 edges and more that is one.
        let ahead = BASE_SPACING.div_ceil(edges).wrapping_mul(edges);
        let start = edge.wrapping_add(ahead).wrapping_sub(HALF);
        let sum = (0..=BASE_SPACING).fold(0_i64, |sum, offset| {
            let at = start.wrapping_add(offset).checked_rem(edges).unwrap_or(0);
            let weight = if offset % BASE_SPACING == 0 { 1 } else { 2 };
            sum.wrapping_add(self.of(at).wrapping_mul(weight))
        });
        // Weights of twice 64.
        sum.wrapping_shr(const { (2 * BASE_SPACING).ilog2() })
    }
}

fn write_base(rest: &Rest<'_>, base: &mut [[u8; 2]]) -> Result<(), EncodeError> {
    const BITS: u32 = EXACT_FRAC - BASE_FRAC;
    let zero = rest.smooth(0);
    for (entry, edge) in base
        .iter_mut()
        .zip((0_u32..).step_by(BASE_SPACING as usize))
    {
        let slow = rest.smooth(edge).wrapping_sub(zero);
        let rounded = slow.wrapping_add(1 << (BITS - 1)).wrapping_shr(BITS);
        *entry = i16::try_from(rounded)
            .map_err(|_| EncodeError::Base {
                edge,
                error: to_q16(slow),
            })?
            .to_le_bytes();
    }
    Ok(())
}

/// Writes the bytes and returns the bits of their step.
fn write_bytes(rest: &Rest<'_>, base: &[[u8; 2]], out: &mut [u8]) -> Result<u8, EncodeError> {
    let zero = rest.smooth(0);
    let misfits = || {
        let segments = base.array_windows();
        let levels = segments.flat_map(|pair| {
            let [before, after] = pair.map(|entry| i64::from(i16::from_le_bytes(entry)));
            let rise = after.wrapping_sub(before);
            let level = before.wrapping_mul(i64::from(BASE_SPACING));
            (0..i64::from(BASE_SPACING)).map(move |at| level.wrapping_add(rise.wrapping_mul(at)))
        });
        let edges = 0..rest.content.edges;
        edges.zip(levels).map(move |(edge, level)| {
            let misfit = rest.of(edge).wrapping_sub(zero).wrapping_sub(level);
            (edge, misfit)
        })
    };
    let mut extremes = [(0, 0); 2];
    for (edge, misfit) in misfits() {
        let [(_, lowest), (_, highest)] = &extremes;
        if misfit < *lowest {
            extremes = [(edge, misfit), extremes[1]];
        } else if misfit > *highest {
            extremes = [extremes[0], (edge, misfit)];
        }
    }
    let worst = extremes
        .into_iter()
        .max_by_key(|(_, misfit)| misfit.unsigned_abs());
    let (edge, misfit) = worst.unwrap_or_default();
    let fits = |bits: &u8| {
        extremes
            .iter()
            .all(|(_, misfit)| byte(*misfit, *bits).is_some())
    };
    let bits = (STEP_BITS.0..=STEP_BITS.1)
        .rev()
        .find(fits)
        .ok_or(EncodeError::Misfit {
            edge,
            misfit: to_q16(misfit),
        })?;
    for (out, (_, misfit)) in out.iter_mut().zip(misfits()) {
        *out = byte(misfit, bits).unwrap_or(BYTE_ZERO);
    }
    Ok(bits)
}

/// The byte of a misfit at a step of 2^-`bits` d.
fn byte(misfit: i64, bits: u8) -> Option<u8> {
    let shift = EXACT_FRAC.wrapping_sub(u32::from(bits));
    let half = 1_i64.wrapping_shl(shift.wrapping_sub(1));
    let steps = misfit.wrapping_add(half).wrapping_shr(shift);
    u8::try_from(steps.wrapping_add(i64::from(BYTE_ZERO))).ok()
}

fn to_q16(exact: i64) -> i32 {
    let rounded = exact.wrapping_shr(EXACT_FRAC - ERROR_FRAC);
    crate::estimator::saturate(rounded)
}

fn write_header(
    content: &MapContent<'_>,
    phases: &[[i16; 4]; 2],
    form: Form,
    step_bits: u8,
    header: &mut [u8],
) -> Option<()> {
    let known = |front: Option<i16>, bit: u16| front.map_or(0, |_| bit);
    let [forward, backward] = content.fronts;
    let Residual {
        short_wave_d,
        slope,
        curvature_per_d,
        noise_d,
        noise_s,
        hysteresis_d,
    } = content.residual;

    let mut left = header;
    let mut put = |bytes: &[u8]| {
        let (place, rest) = core::mem::take(&mut left).split_at_mut_checked(bytes.len())?;
        place.copy_from_slice(bytes);
        left = rest;
        Some(())
    };
    put(&MAGIC)?;
    put(&VERSION.to_le_bytes())?;
    put(&[form.code(), step_bits])?;
    put(&content.edges.to_le_bytes())?;
    put(&(BASE_SPACING as u16).to_le_bytes())?;
    put(&(known(forward, 1) | known(backward, 2)).to_le_bytes())?;
    for front in content.fronts {
        put(&front.unwrap_or(0).to_le_bytes())?;
    }
    for phase in phases.iter().flatten() {
        put(&phase.to_le_bytes())?;
    }
    for figure in [
        short_wave_d,
        slope,
        curvature_per_d,
        noise_d,
        noise_s,
        hysteresis_d,
    ] {
        put(&figure.to_le_bytes())?;
    }
    put(&(image_len(content.edges, form) as u32).to_le_bytes())
}
