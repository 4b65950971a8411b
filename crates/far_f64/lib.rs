//! Nothing but a place for the tests in `tests/`: the engine in double precision.
