#pragma once

/// The one place where the version stands: CMake and the Python build read this line.
#define POLHODE_VERSION "0.3.0"
