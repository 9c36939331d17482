#pragma once

#include <cstddef>
#include <string_view>

namespace driftless {

/// The instructions that this library was compiled for, by Highway's name: "SSE4" (x86-64-v2),
/// "AVX2" (x86-64-v3) or "AVX3" (x86-64-v4, which has AVX-512), as the loader chose it for this
/// processor; or others where it was compiled for one processor alone.
std::string_view instruction_set();

/// How many doubles this library handles at once: its Lanes::count(), which need not be the one of
/// a program or module, compiled for other instructions.
std::size_t lanes_of_library();

}  // namespace driftless
