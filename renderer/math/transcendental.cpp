#include "renderer/math/transcendental.h"
