//! An empty package for the tests in `tests/`: the engine in double precision.
