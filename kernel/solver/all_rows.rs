//! All rows of a step: the list of constraint kinds, and the sorting of constraints into batches.

use super::batch::Batch;
use super::color_layer::{ColorLayer, Sorter};
use super::contact_batch::{CONTACT_BATCHES, ContactRows, ContactView, Room, sort_contacts};
use super::custom::{self, CUSTOM_BATCHES, CustomRows, CustomTable, CustomView, customs, sort_customs};
use super::joint::{
    JOINT_BATCHES, JointRows, JointTable, JointTrees, JointViews, Records, joints, sort_joints,
};
use super::plan::{Plan, Planned};
use crate::graph::{COLOR_COUNT, ColorGraph, OVERFLOW};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Entry, F32x4, Lane, Shared, Width};
use crate::thread_pool::ThreadPool;

/// Rows of every lane width. Only one of the wide widths is in use.
#[derive(Clone, Debug, Default)]
pub(super) struct AllRows {
    pub(super) width: Width,
    overflow: KindRows<f32>,
    /// Contacts of the overflow that share rows, if there are many.
    shared: ContactRows<Shared<F32x4>>,
    four: KindRows<F32x4>,
    #[cfg(target_arch = "x86_64")]
    eight: KindRows<F32x8>,
}

/// The rows of one width, by kind.
#[derive(Clone, Debug, Default)]
struct KindRows<N: Lane> {
    contacts: ContactRows<N>,
    joints: JointRows<N>,
    customs: CustomRows,
}

/// Number of batches of one width.
const BATCHES: usize = CUSTOM + CUSTOM_BATCHES;
/// The first batch of joints; contact batches come before it.
const JOINT: usize = CONTACT_BATCHES;
/// The first batch of custom constraints.
const CUSTOM: usize = JOINT + JOINT_BATCHES;

/// The first batch of rows that share bodies; batches of single overflow constraints come before it.
const SHARED: usize = BATCHES;
/// The first batch of wide rows.
const WIDE: usize = SHARED + CONTACT_BATCHES;

/// Minimum number of overflow contacts for which they share rows. Fewer are solved one by one, which
/// converges faster.
const WORTH_SHARED_ROWS: usize = 32;

/// Tables that are read to sort constraints.
#[derive(Clone, Copy)]
pub(super) struct SortedTables<'a> {
    pub(super) joints: (&'a JointTable, &'a JointTrees),
    pub(super) customs: &'a CustomTable,
}

/// The layers of each colour. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct ColorLayers {
    colors: Vec<Vec<ColorLayer>>,
    /// Number of layers in use, by colour.
    used: Vec<usize>,
}

impl ColorLayers {
    /// The layers of each colour. The last ones may be unused.
    pub(super) fn colors(&self) -> &[Vec<ColorLayer>] {
        &self.colors
    }

    /// Sorts the constraints of all colours. Each colour is sorted by one worker.
    pub(super) fn sort(
        &mut self,
        colors: &ColorGraph,
        tables: SortedTables,
        sorter: &Sorter,
        pool: &ThreadPool,
    ) {
        self.colors.resize_with(COLOR_COUNT, Vec::new);
        self.used.resize(COLOR_COUNT, 0);
        let layers = self.colors.iter_mut().zip(&mut self.used).zip(0..);
        pool.each(layers, |((layers, used), color)| {
            *used = if color == OVERFLOW {
                sort_overflow(colors, tables, sorter, layers)
            } else {
                sort_color((colors, color), tables, sorter, layers)
            };
        });
    }

    /// Plans the stages of all colours: the overflow first, then in ascending order.
    pub(super) fn plan(&self, width: Width, sorter: &Sorter, plan: &mut Plan) {
        let lanes = match width {
            Width::Eight(_) => 8,
            Width::Four => 4,
        };
        let overflow = &self.colors[usize::from(OVERFLOW)][..self.used[usize::from(OVERFLOW)]];
        if let [singles, shared] = overflow {
            let planned = Planned { color: OVERFLOW, number: 0, layer: singles, first_batch: 0, width: 1 };
            plan.add_singly(&planned);
            let width = F32x4::WIDTH as u32;
            plan.add(
                &Planned { number: 1, layer: shared, first_batch: SHARED, width, ..planned },
                sorter.partition,
            );
        }
        for color in 0..OVERFLOW {
            let used = self.used[usize::from(color)];
            for (layer, number) in self.colors[usize::from(color)][..used].iter().zip(0..) {
                let planned = Planned { color, number, layer, first_batch: WIDE, width: lanes };
                plan.add(&planned, sorter.partition);
            }
        }
    }
}

/// The layer with a number. It is created if it is the next one.
fn layer(layers: &mut Vec<ColorLayer>, number: usize) -> &mut ColorLayer {
    if number == layers.len() {
        layers.push(ColorLayer::default());
    }
    &mut layers[number]
}

/// Sorts the constraints of a colour into layers. Returns the number of layers.
fn sort_color(
    (colors, color): (&ColorGraph, u8),
    tables: SortedTables,
    sorter: &Sorter,
    layers: &mut Vec<ColorLayer>,
) -> usize {
    let (contacts, joints, customs) = (colors.contacts(color), joints(colors, color), customs(colors, color));
    let (mut left, mut number) = (contacts.len() + joints.len() + customs.len(), 0);
    while left > 0 {
        let layer = layer(layers, number);
        layer.begin(BATCHES, sorter.partition.parts(left));
        left = sort_contacts(contacts, number as u32, sorter, layer);
        if number == 0 {
            sort_joints(joints, JOINT, tables.joints, sorter, layer);
            sort_customs(customs, CUSTOM, tables.customs, sorter, layer);
        }
        number += 1;
    }
    number
}

/// Sorts the overflow constraints into two layers: constraints solved one by one, in their order, and
/// contacts that share rows. Returns the number of layers.
///
/// Decision: many contacts without a colour belong to a hub, a body that touches hundreds of others. Four
/// of them share a row, and the hub is split into one body of equal mass per lane, whose mean velocity it
/// gets (mass splitting: Tonge, Benevolenski, Voroshilov, "Mass Splitting for Jitter-Free Parallel Rigid
/// Body Simulation", 2012). Mass splitting conserves momentum and adds no energy, at any mass ratio, and
/// hardly affects a heavy hub, as most hubs are. A row has four lanes on every CPU, because the result
/// depends on the number of bodies into which a hub is split. In steps with deep overlap all contacts stay
/// single, as they work against each other.
fn sort_overflow(
    colors: &ColorGraph,
    tables: SortedTables,
    sorter: &Sorter,
    layers: &mut Vec<ColorLayer>,
) -> usize {
    let (joints, customs) = (joints(colors, OVERFLOW), customs(colors, OVERFLOW));
    if colors.overflow().is_empty() && joints.is_empty() && customs.is_empty() {
        return 0;
    }
    layers.resize_with(layers.len().max(2), ColorLayer::default);
    let [singles, shared, ..] = &mut layers[..] else { return 0 };
    singles.begin_ordered(BATCHES);
    shared.begin(CONTACT_BATCHES, 1);
    sort_joints(joints, JOINT, tables.joints, sorter, singles);
    sort_customs(customs, CUSTOM, tables.customs, sorter, singles);
    let many = colors.overflow().len() >= WORTH_SHARED_ROWS && !sorter.input.contacts.any_deep;
    for contact in colors.overflow() {
        let layer = if many { &mut *shared } else { &mut *singles };
        let mut index = 0;
        while sort_contacts(core::slice::from_ref(contact), index, sorter, layer) > 0 {
            index += 1;
        }
    }
    2
}

impl AllRows {
    /// Number of batches: of single constraints, of rows that share bodies, and of wide rows.
    pub(super) const BATCHES: usize = WIDE + BATCHES;

    /// Empties all rows without keeping their storage.
    pub(super) fn give_back(&mut self) {
        *self = Self { width: self.width, ..Self::default() };
    }

    /// Resizes the rows of each batch. Their content is stale.
    pub(super) fn make_room(&mut self, rows: &[u32], room: Room) {
        let (overflow, wide) = rows.split_at(WIDE);
        self.overflow.make_room(overflow, room);
        self.shared.make_room(&overflow[SHARED..], room);
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => self.eight.make_room(wide, room),
            _ => self.four.make_room(wide, room),
        }
    }

    /// Number of manifolds among the items, given the number of items of each batch.
    pub(super) fn count_manifolds(items: &[u32]) -> usize {
        let of_contacts =
            [0, SHARED, WIDE].into_iter().flat_map(|first| items.iter().skip(first).take(CONTACT_BATCHES));
        of_contacts.sum::<u32>() as usize
    }

    /// Calls a function with all batches, by number.
    pub(super) fn with<R>(
        &mut self,
        joints: &mut JointTable,
        customs: &mut CustomTable,
        f: impl FnOnce(&[&dyn Batch]) -> R,
    ) -> R {
        let records = &AllRecords { joints: joints.records(), customs: customs.records() };
        let overflow = self.overflow.view((), records);
        let shared = self.shared.view(());
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(avx2) => overflow.and(&shared, &self.eight.view(avx2, records), f),
            _ => overflow.and(&shared, &self.four.view((), records), f),
        }
    }
}

/// The records of constraints that have any.
struct AllRecords<'a> {
    joints: Records<'a>,
    customs: custom::Records<'a>,
}

impl<N: Entry> KindRows<N> {
    fn make_room(&mut self, rows: &[u32], room: Room) {
        self.contacts.make_room(rows, room);
        self.joints.make_room(&rows[JOINT..CUSTOM]);
        self.customs.make_room(rows[CUSTOM], N::WIDTH);
    }

    fn view<'a>(&'a mut self, proof: N::Proof, records: &'a AllRecords<'a>) -> KindViews<'a, N> {
        let Self { contacts, joints, customs } = self;
        KindViews {
            contacts: contacts.view(proof),
            joints: joints.view(proof, &records.joints),
            customs: customs.view(N::WIDTH, &records.customs),
        }
    }
}

/// A view of [`KindRows`] whose blocks are changed by several threads.
struct KindViews<'a, N: Entry> {
    contacts: ContactView<'a, N>,
    joints: JointViews<'a, N>,
    customs: CustomView<'a>,
}

impl<N: Entry> KindViews<'_, N> {
    fn batches(&self) -> [&dyn Batch; BATCHES] {
        let contacts = self.contacts.batches();
        core::array::from_fn(|i| match i {
            _ if i < JOINT => contacts[i],
            _ if i < CUSTOM => self.joints.batch(i - JOINT),
            _ => &self.customs,
        })
    }

    /// Calls a function with these batches, then the batches that share bodies, then the wide ones.
    fn and<S: Entry, W: Entry, R>(
        &self,
        shared: &ContactView<S>,
        wide: &KindViews<W>,
        f: impl FnOnce(&[&dyn Batch]) -> R,
    ) -> R {
        let (single, shared, wide) = (self.batches(), shared.batches(), wide.batches());
        let all: [&dyn Batch; AllRows::BATCHES] = core::array::from_fn(|i| match i {
            _ if i < SHARED => single[i],
            _ if i < WIDE => shared[i - SHARED],
            _ => wide[i - WIDE],
        });
        f(&all)
    }
}
