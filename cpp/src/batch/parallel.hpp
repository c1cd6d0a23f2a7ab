#pragma once

#include "core/parallel.hpp"
