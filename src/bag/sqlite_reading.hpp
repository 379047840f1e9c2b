// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridmerge::internal {

/// The name of a system of files for SQLite (a VFS) that opens databases as they are named, whichever links
/// lead there, and only reads them. The usual one cannot open a file without a name. Null when SQLite denies
/// it.
const char* sqlite_reading();

}  // namespace gridmerge::internal
