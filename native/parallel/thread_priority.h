#pragma once

namespace komorebi {

enum class Priority { kNormal, kLow };

/// Lets all threads of normal priority come before the calling one, from now on: so that whoever
/// draws what is rendered, in this process or another, need not share its processor. What few
/// processors are left with for it is a tenth. Where the system has no means for that, nothing
/// happens.
void lower_priority();

}  // namespace komorebi
