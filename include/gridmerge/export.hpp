// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what programs may link: every function, every class with a member that a library defines, and every
/// exception of a public header. The libraries are compiled with hidden visibility, so a shared library
/// offers nothing else.
#define GRIDMERGE_EXPORT [[gnu::visibility("default")]]
