#include "mpm/material/law.hpp"
