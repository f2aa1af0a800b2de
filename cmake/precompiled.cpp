// Only carries cmake/precompiled.h.
