//! Many queries in one call, shared by the caller and the threads of Bevy's compute task pool.

use bevy_tasks::ComputeTaskPool;
use std::sync::{Mutex, PoisonError};

use super::{
    PointProjection, RayHitData, ShapeCastConfig, ShapeHitData, SpatialQueryFilter,
    system_param::{EVERY, SpatialQuery, pose_of},
};
use crate::{
    collision::collider::Collider,
    math::{Dir, RotationValue, Scalar, Vector},
};

/// Number of queries that a thread takes at once. A smaller number balances better; a larger one costs less
/// to distribute.
const CHUNK: usize = 256;

/// Many queries at once. The results equal the results of single queries, for any number of threads, and are
/// in the order of the questions.
///
/// Answers are written to a slice, so that its memory can be reused. If it is longer than the slice of
/// questions, the rest becomes `None`; if it is shorter, the last questions are skipped.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn scan(queries: SpatialQuery, mut hits: Local<Vec<Option<RayHitData>>>) {
///     let rays: Vec<(Vector, Dir)> = (0..1000).map(|i| (Vector::X * i as Scalar, Dir::NEG_Y)).collect();
///     hits.resize(rays.len(), None);
///     queries.cast_rays(&rays, 100.0, true, &SpatialQueryFilter::default(), &mut hits);
/// }
/// ```
impl SpatialQuery<'_, '_> {
    /// The first hit of each ray, as in [`cast_ray`](Self::cast_ray).
    pub fn cast_rays(
        &self,
        rays: &[(Vector, Dir)],
        max_distance: Scalar,
        solid: bool,
        filter: &SpatialQueryFilter,
        hits: &mut [Option<RayHitData>],
    ) {
        let first = self.first_hits();
        answer(rays, hits, |(origin, direction)| {
            first.of_ray(*origin, *direction, max_distance, solid, filter, EVERY)
        });
    }

    /// The first hit of a shape for each start and direction, as in [`cast_shape`](Self::cast_shape).
    pub fn cast_shapes(
        &self,
        shape: &Collider,
        casts: &[(Vector, RotationValue, Dir)],
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
        hits: &mut [Option<ShapeHitData>],
    ) {
        let first = self.first_hits();
        answer(casts, hits, |(origin, rotation, direction)| {
            first.of_shape((shape, pose_of(*origin, *rotation)), *direction, config, filter, EVERY)
        });
    }

    /// The nearest collider to each point, as in [`project_point`](Self::project_point).
    pub fn project_points(
        &self,
        points: &[Vector],
        solid: bool,
        filter: &SpatialQueryFilter,
        projections: &mut [Option<PointProjection>],
    ) {
        let first = self.first_hits();
        answer(points, projections, |point| first.of_point(*point, solid, filter, EVERY));
    }
}

/// Answers questions in chunks, by several threads if there are many.
fn answer<Q: Sync, A: Send>(
    questions: &[Q],
    answers: &mut [Option<A>],
    ask: impl Fn(&Q) -> Option<A> + Sync,
) {
    let count = questions.len().min(answers.len());
    let (asked, rest) = answers.split_at_mut(count);
    rest.iter_mut().for_each(|answer| *answer = None);
    let chunks = Mutex::new(questions.chunks(CHUNK).zip(asked.chunks_mut(CHUNK)));
    let next_chunk = || chunks.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = &|| {
        while let Some((questions, answers)) = next_chunk() {
            for (question, answer) in questions.iter().zip(answers) {
                *answer = ask(question);
            }
        }
    };
    let Some(pool) = ComputeTaskPool::try_get().filter(|_| count > CHUNK) else { return work() };
    // One task per thread, since the end of each task wakes the caller.
    let helpers = pool.thread_num().min(count.div_ceil(CHUNK) - 1);
    pool.scope(|scope| {
        for _ in 0..helpers {
            scope.spawn(async move { work() });
        }
        // The caller may be a thread of the pool, which would then be missing.
        scope.spawn_on_scope(async move { work() });
    });
}
