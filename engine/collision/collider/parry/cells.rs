//! Merges the cells of a grid into few boxes: rows of cells, then sheets of rows, then blocks of sheets.

use crate::math::DIM;
use crate::parry::math::IVector;

/// The lowest and the highest cell of a box.
pub(super) type CellBox = [IVector; 2];

/// The cells as boxes, in ascending order of their ends across the last axis. Duplicate cells count once.
pub(super) fn joined(cells: &[IVector]) -> Vec<CellBox> {
    match Grid::of(cells) {
        Some(grid) => grid.joined(),
        None => joined_sparse(cells),
    }
}

/// Maximum number of places per cell for which a grid is filled; above it, cells are sorted. A larger value
/// takes more memory for scattered cells.
const PLACES: usize = 16;

/// The grid around the cells, one bit per place.
struct Grid {
    low: [i128; DIM],
    /// The number of places along each axis, 1 along an axis that does not exist.
    sizes: [usize; 3],
    filled: Vec<u64>,
}

/// A box of places; the lowest and the highest along each axis.
type Places = [[u32; 2]; 3];

/// No box.
const NONE: u32 = u32::MAX;

impl Grid {
    /// `None` for no cells, and for cells that are far apart.
    fn of(cells: &[IVector]) -> Option<Self> {
        let wide = |cell: &IVector| cell.to_array().map(i128::from);
        let first = wide(cells.first()?);
        let (mut low, mut high) = (first, first);
        for cell in cells.iter().map(wide) {
            for axis in 0..DIM {
                low[axis] = low[axis].min(cell[axis]);
                high[axis] = high[axis].max(cell[axis]);
            }
        }
        let mut sizes = [1; 3];
        for axis in 0..DIM {
            sizes[axis] = usize::try_from(high[axis] - low[axis] + 1).ok()?;
        }
        let places = sizes.iter().try_fold(1_usize, |product, size| product.checked_mul(*size))?;
        if places > PLACES * cells.len() || places >= NONE as usize {
            return None;
        }
        let mut filled = vec![0; places.div_ceil(64)];
        for cell in cells.iter().map(wide) {
            let at = (0..DIM).rev().fold(0, |at, axis| at * sizes[axis] + (cell[axis] - low[axis]) as usize);
            filled[at / 64] |= 1 << (at % 64);
        }
        Some(Self { low, sizes, filled })
    }

    fn is_filled(&self, at: usize) -> bool {
        self.filled[at / 64] >> (at % 64) & 1 != 0
    }

    fn joined(&self) -> Vec<CellBox> {
        let [width, height, depth] = self.sizes;
        let mut blocks: Vec<Places> = Vec::new();
        // The last block with each lowest corner in a layer, and the last sheet of the layer with each start
        // in a row.
        let mut of_corner = vec![NONE; width * height];
        let (mut sheets, mut of_start): (Vec<Places>, _) = (Vec::new(), vec![NONE; width]);
        for z in 0..depth {
            sheets.clear();
            of_start.fill(NONE);
            for y in 0..height {
                let row = width * (y + height * z);
                let mut x = 0;
                while x < width {
                    if !self.is_filled(row + x) {
                        x += 1;
                        continue;
                    }
                    let start = x;
                    while x < width && self.is_filled(row + x) {
                        x += 1;
                    }
                    let row = [[start, x - 1], [y, y], [z, z]].map(|ends| ends.map(|end| end as u32));
                    extend(&mut sheets, &mut of_start[start], row, 1);
                }
            }
            for sheet in &sheets {
                let corner = sheet[0][0] as usize + width * sheet[1][0] as usize;
                extend(&mut blocks, &mut of_corner[corner], *sheet, 2);
            }
        }
        blocks.sort_unstable_by_key(|block| order(&core::array::from_fn(|end| block.map(|ends| ends[end]))));
        blocks.into_iter().map(|block| core::array::from_fn(|end| self.cell(&block, end))).collect()
    }

    /// An end of a block.
    fn cell(&self, block: &Places, end: usize) -> IVector {
        // The cell lies between the lowest and the highest cell, so it is in range.
        IVector::from_array(core::array::from_fn(|axis| {
            (self.low[axis] + i128::from(block[axis][end])).try_into().unwrap_or_default()
        }))
    }
}

/// Extends the box `last` by `next` if that continues it along an axis. Otherwise adds `next` as a new box.
fn extend(boxes: &mut Vec<Places>, last: &mut u32, next: Places, axis: usize) {
    if let Some(last) = boxes.get_mut(*last as usize) {
        let is_alike = (0..3).all(|other| other == axis || last[other] == next[other]);
        if is_alike && last[axis][1] + 1 == next[axis][0] {
            last[axis][1] = next[axis][1];
            return;
        }
    }
    *last = boxes.len() as u32;
    boxes.push(next);
}

/// The sort key of boxes with these ends.
fn order<T: Copy + Default + Ord, const N: usize>(ends: &[[T; N]; 2]) -> ([[T; N]; 2], T) {
    let mut across = *ends;
    across.iter_mut().for_each(|end| end[DIM - 1] = T::default());
    (across, ends[0][DIM - 1])
}

/// The same boxes by sorting, for cells that are far apart.
fn joined_sparse(cells: &[IVector]) -> Vec<CellBox> {
    let mut boxes: Vec<CellBox> = cells.iter().map(|cell| [*cell, *cell]).collect();
    for axis in 0..DIM {
        // Boxes that may be joined are neighbours: equal across the axis, in order along it.
        let across = |b: &CellBox| {
            let mut ends = b.map(|end| end.to_array());
            ends.iter_mut().for_each(|end| end[axis] = 0);
            ends
        };
        boxes.sort_unstable_by_key(|b| (across(b), b[0][axis]));
        boxes.dedup_by(|next, last| {
            let is_next =
                across(next) == across(last) && i64::from(next[0][axis]) <= i64::from(last[1][axis]) + 1;
            if is_next {
                last[1][axis] = last[1][axis].max(next[1][axis]);
            }
            is_next
        });
    }
    boxes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[allow(clippy::useless_conversion, reason = "coordinates are i32 or i64")]
    fn cell(c: [i32; 3]) -> IVector {
        IVector::from_array(core::array::from_fn(|i| c[i].into()))
    }

    proptest! {
        #[test]
        fn joined_boxes_cover_all_cells_once(cells in prop::collection::vec([-2..3i32, 0..4, 0..4], 0..60)) {
            let cells: Vec<IVector> = cells.into_iter().map(cell).collect();
            let boxes = joined(&cells);
            let unique: std::collections::BTreeSet<_> = cells.iter().map(|c| c.to_array()).collect();
            let mut count = 0;
            for [low, high] in &boxes {
                count += (0..DIM).fold(1, |count, i| count * (high[i] - low[i] + 1));
            }
            prop_assert_eq!(count as usize, unique.len());
            for c in &cells {
                let inside = |b: &&CellBox| (0..DIM).all(|i| b[0][i] <= c[i] && c[i] <= b[1][i]);
                prop_assert_eq!(boxes.iter().filter(inside).count(), 1);
            }
            prop_assert_eq!(boxes, joined_sparse(&cells), "both ways make the same boxes in the same order");
        }
    }

    #[test]
    fn a_floor_of_cells_is_one_box() {
        let cells: Vec<_> = (0..9).map(|i| cell([i % 3, i / 3, 0])).collect();
        assert_eq!(joined(&cells).len(), 1);
    }

    #[test]
    fn cells_at_the_ends_of_their_range_are_boxes() {
        let cells = [cell([i32::MIN; 3]), cell([i32::MAX; 3])];
        assert_eq!(joined(&cells), cells.map(|cell| [cell, cell]));
        assert_eq!(joined(&cells[..1]), [[cells[0]; 2]]);
        assert!(joined(&[]).is_empty());
    }
}
