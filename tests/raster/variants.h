// The variants of the golden frames are those of every test of raster/.
#pragma once

#include "golden/variants.h"
