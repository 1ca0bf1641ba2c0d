// See usual_headers.hpp: CMake precompiles the headers of a target that has a source.
#include "tests/usual_headers.hpp"
