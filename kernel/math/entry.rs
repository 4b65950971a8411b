//! Entry points: the functions at which code compiled for the CPU features of a lane begins.
#![expect(unsafe_code, reason = "an entry point has a CPU feature that its caller may not have")]

use super::F32x4;
#[cfg(target_arch = "x86_64")]
use super::{Avx2, F32x8};
use super::{Lane, Shared, Width};

/// Work of an entry point.
///
/// [`run`](Self::run) and all functions below it must be `#[inline(always)]`: a function that is not inlined
/// is not compiled for the feature. Each type of job has an entry point of its own. Without optimisation,
/// inlined values have separate places on the stack: all passes over contact rows in one function took 4.6 MB
/// of stack in 3D, where threads have two.
pub(crate) trait Job {
    /// The result of the work.
    type Output;

    /// Does the work.
    ///
    /// # Safety
    /// As the job demands.
    unsafe fn run(self) -> Self::Output;
}

/// A lane with entry points.
pub(crate) trait Entry: Lane {
    /// The proof that the CPU has the lane's features.
    type Proof: Copy + Send + Sync;

    /// Runs a job in an entry point of its own.
    ///
    /// # Safety
    /// As the job demands.
    unsafe fn enter<J: Job>(proof: Self::Proof, job: J) -> J::Output;

    /// As [`enter`](Self::enter), but a job with single floats is compiled for the features of a width.
    ///
    /// # Safety
    /// As the job demands.
    unsafe fn enter_widest<J: Job>(proof: Self::Proof, _width: Width, job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe { Self::enter(proof, job) }
    }
}

impl Entry for f32 {
    type Proof = ();

    #[inline(never)]
    unsafe fn enter<J: Job>((): (), job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe { job.run() }
    }

    unsafe fn enter_widest<J: Job>((): (), width: Width, job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe {
            match width {
                #[cfg(target_arch = "x86_64")]
                Width::Eight(avx2) => F32x8::enter(avx2, job),
                _ => f32::enter((), job),
            }
        }
    }
}

impl Entry for F32x4 {
    type Proof = ();

    #[inline(never)]
    unsafe fn enter<J: Job>((): (), job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe { job.run() }
    }
}

impl Entry for Shared<F32x4> {
    type Proof = ();

    #[inline(never)]
    unsafe fn enter<J: Job>((): (), job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe { job.run() }
    }
}

#[cfg(target_arch = "x86_64")]
impl Entry for F32x8 {
    type Proof = Avx2;

    unsafe fn enter<J: Job>(_: Avx2, job: J) -> J::Output {
        #[target_feature(enable = "avx2")]
        unsafe fn avx2<J: Job>(job: J) -> J::Output {
            // SAFETY: by the contract.
            unsafe { job.run() }
        }
        // SAFETY: the caller has the proof that the CPU has AVX2; and by the contract.
        unsafe { avx2(job) }
    }
}
