# The sources of own_words besides own_words.c. companion/ uses them, too.
set(own_words_parts own_words_distance.c own_words_ear.c own_words_levels.c own_words_speech.c own_words_warp.c)
list(TRANSFORM own_words_parts PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
