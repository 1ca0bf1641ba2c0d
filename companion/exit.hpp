// The exit codes of a module's program, which tell rsc whether starting it again helps (docs/companion.md). This header includes
// nothing, so that rsc can use it, too.
#pragma once

namespace robosync::companion {

enum class Exit {
  over = 0,
  asked_wrongly = 2,  // starting it again would not help
  outside = 3
};

}  // namespace robosync::companion
