#include "ar/error.h"
