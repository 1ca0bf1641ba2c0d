// How the program of a module ends, which tells rsc whether it helps to start it again (docs/companion.md). Nothing is included
// here, so that rsc can read it, too.
#pragma once

namespace robosync::companion {

enum class Exit {
  over = 0,
  asked_wrongly = 2,  // the same again would not help
  outside = 3
};

}  // namespace robosync::companion
