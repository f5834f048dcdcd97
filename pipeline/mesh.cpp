#include "pipeline/mesh.h"
