"""scripts/mutate modules: what confines a module in a file, and what believes nothing that it says of itself, broken on purpose, one check at a
time (changes.py). Who should notice are modules that break their word: tests/runtime-m4/module_files."""

import sys

from changes import Mutant, Suite, run

FOLDER = "runtime-m4/module_files/"
CONFINE, WORKER, PROCESS = FOLDER + "confine.cpp", FOLDER + "worker.cpp", FOLDER + "process.cpp"
DESCRIPTION, REGISTRY = FOLDER + "description.cpp", FOLDER + "registry.cpp"

MUTANTS = (
    Mutant("while it is loaded it may call what it likes", CONFINE, "return allow(kLoading, true);", "return true;"),
    Mutant("once loaded it may call what a loader may", CONFINE, "return allow(kAnswers, false);", "return true;"),
    Mutant("what no list names is allowed", CONFINE, "  filter.push_back(kEnd);\n  const", "  filter.push_back(kAllow);\n  const"),
    Mutant("another machine's calls are taken for this one's", CONFINE,
           "  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0));\n  filter.push_back(kEnd);\n", "",
           "a test does, where the kernel takes calls of 32 bits; this one does not"),
    Mutant("a file may be opened to write", CONFINE, "O_WRONLY | O_RDWR | O_CREAT", "O_RDWR | O_CREAT"),
    Mutant("a file may be opened to read and write", CONFINE, "O_WRONLY | O_RDWR | O_CREAT", "O_WRONLY | O_CREAT"),
    Mutant("a file may be made", CONFINE, "O_RDWR | O_CREAT | O_TRUNC", "O_RDWR | O_TRUNC"),
    Mutant("a file may be emptied", CONFINE, "O_CREAT | O_TRUNC | O_APPEND", "O_CREAT | O_APPEND"),
    Mutant("a file may be opened to append", CONFINE, " | O_APPEND", "", "who appends writes: the flag alone opens a file to read"),

    Mutant("what lies behind its memory is open", WORKER, "mprotect(page_, kPage, PROT_READ | PROT_WRITE)",
           "mprotect(page_, 2 * kPage, PROT_READ | PROT_WRITE)"),
    Mutant("its memory ends somewhere in the page", WORKER, "begin_ = kPage - (bytes + 7) / 8 * 8;", "begin_ = 64;"),
    Mutant("what lies before its memory is not looked at", WORKER,
           "std::ranges::all_of(whole().first(begin_), is_untouched) &&", ""),
    Mutant("what lies between its memory and the page's end is not looked at", WORKER,
           "&&\n           std::ranges::all_of(whole().subspan(end_), is_untouched);", ";"),
    Mutant("nobody looks around its state", WORKER, "if (!self.state.is_intact()) end(Came::beyond_state);", ""),
    Mutant("nobody looks around its scratch", WORKER, "if (!self.scratch.is_intact()) end(Came::beyond_scratch);", ""),
    Mutant("nobody looks around its outputs", WORKER, "if (!self.outputs.is_intact()) end(Came::beyond_outputs);", ""),
    Mutant("its static variables stay open", WORKER, "self.statics.end - begin, PROT_READ)", "self.statics.end - begin, PROT_READ | PROT_WRITE)"),
    Mutant("nobody says where it touched what", WORKER, "watches(SIGSEGV) && ", ""),
    Mutant("nobody says that it divided by zero", WORKER, "watches(SIGFPE) && ", ""),
    Mutant("nobody says that it trapped", WORKER, " && watches(SIGILL)", ""),
    Mutant("nobody is left to say that its stack was too small", WORKER, "SA_SIGINFO | SA_ONSTACK", "SA_SIGINFO"),
    Mutant("a text that is not there is read", WORKER, "if (text == nullptr) end(Came::incomplete);", ""),
    Mutant("more words than there is room for are copied", WORKER, "if (words + copy.words > kMostWords) end(Came::too_many);", ""),
    Mutant("a description without a module is read", WORKER, "if (self.description->module == nullptr) end(Came::incomplete);", ""),
    Mutant("a function that is not there is called", WORKER, "if (!is_complete(*self.description)) end(Came::incomplete);", ""),
    Mutant("more inputs than there is room for", WORKER, "module.inputs > ROBOSYNC_MOST_INPUTS || ", ""),
    Mutant("more outputs than there is room for", WORKER, " || module.outputs > ROBOSYNC_MOST_OUTPUTS ||", " ||"),
    Mutant("more parameters than there is room for", WORKER, "||\n      module.parameters > ROBOSYNC_MOST_PARAMETERS)", ")"),
    Mutant("a file without the function is called", WORKER, "if (describe_it == nullptr) end(Came::no_function);", ""),
    Mutant("another interface is read", WORKER, "if (self.description == nullptr) end(Came::other_interface);", ""),
    Mutant("what it says of its state is believed when it is placed", WORKER,
           "const std::size_t bytes = std::min<std::size_t>(self.reply->sizes.state, ROBOSYNC_MOST_BYTES);\n  std::byte* const state",
           "const std::size_t bytes = self.reply->sizes.state;\n  std::byte* const state"),
    Mutant("what it says of its state is believed when it is taken", WORKER,
           "const std::size_t bytes = std::min<std::size_t>(self.reply->sizes.state, ROBOSYNC_MOST_BYTES);\n  if (!self.state",
           "const std::size_t bytes = self.reply->sizes.state;\n  if (!self.state"),
    Mutant("what it says of its scratch is believed", WORKER, "std::min<std::size_t>(reply.sizes.scratch, ROBOSYNC_MOST_BYTES)",
           "reply.sizes.scratch"),

    Mutant("it can write where it is asked", PROCESS, "void* const read = mmap(nullptr, sizeof(T), PROT_READ, MAP_SHARED",
           "void* const read = mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED"),
    Mutant("its parent's files stay open", PROCESS, "closefrom(STDERR_FILENO + 2);", ""),
    Mutant("its parent's standard files stay open", PROCESS, "    close(standard);", "    (void)standard;"),
    Mutant("it has as much memory as there is", PROCESS, "setrlimit(RLIMIT_AS, &memory);", ""),
    Mutant("the time that it takes is not counted", PROCESS, "cpu_ms_of(child_) - cpu_ms_ > kMostCpuMs || ", ""),
    Mutant("who waits for it waits for ever", PROCESS, " || now_ms() - began_ms > kMostMs", ""),
    Mutant("nobody ends it", PROCESS, "  kill(child_, SIGKILL);\n", ""),
    Mutant("a call that is not allowed is not told from an end", PROCESS, "WTERMSIG(status) == kForbidden", "false"),
    Mutant("who is gone is written to, and takes rsc along", PROCESS, "send(line_, &asked, 1, MSG_NOSIGNAL)", "send(line_, &asked, 1, 0)"),
    Mutant("who has been given up is asked", PROCESS, "  if (!trouble_.empty()) return false;\n  request_->call", "  request_->call"),
    Mutant("what a module that failed has left is taken", PROCESS,
           "  if (!ask(Call::process)) return false;\n  state = reply_->state;", "  ask(Call::process);\n  state = reply_->state;"),
    Mutant("its process may leave a core", PROCESS, "setrlimit(RLIMIT_CORE, &no_core);", "", "this computer's settings say whether there are any"),

    *(Mutant(f"any text is the name of its {what}", DESCRIPTION, f'judge_name("{what}", ', f'if (false) judge_name("{what}", ')
      for what in ("module", "input", "output", "word", "parameter")),
    Mutant("a name may begin with anything", DESCRIPTION, "is_letter(text.front()) &&", "(is_letter(text.front()) || true) &&"),
    Mutant("any unit of an input", DESCRIPTION, 'judge_unit("input", said.input_units[i], true);', ""),
    Mutant("any unit of an output", DESCRIPTION, "judge_unit(what, output.unit, false);", ""),
    Mutant("any unit of a parameter", DESCRIPTION, 'judge_unit("parameter", said.parameter_units[i], true);', ""),
    Mutant("an output in that of the input", DESCRIPTION, "judge_unit(what, output.unit, false);", "judge_unit(what, output.unit, true);"),
    Mutant("an empty range", DESCRIPTION, "output.least >= output.most && output.words != 1", "false"),
    Mutant("words with a unit", DESCRIPTION, "output.unit != ROBOSYNC_NUMBER || ", ""),
    Mutant("words that begin elsewhere", DESCRIPTION, "output.least != 0 ||\n", "\n"),
    Mutant("more values than words", DESCRIPTION, "output.most != (output.words - 1) * ROBOSYNC_ONE", "false"),
    Mutant("two outputs of one name", DESCRIPTION, "if (std::string(other->name.data()) == output.name.data())", "if (false)"),
    *(Mutant(f"counts: {check} is not looked at", DESCRIPTION, check, "false") for check in
      ("said.inputs == 0", "said.inputs > ROBOSYNC_MOST_INPUTS", "said.outputs == 0", "said.outputs > ROBOSYNC_MOST_OUTPUTS",
       "said.parameters > ROBOSYNC_MOST_PARAMETERS", "said.shortest_period_ms == 0", "said.shortest_period_ms > said.usual_period_ms",
       "said.usual_period_ms > said.longest_period_ms", "range.least > range.usual", "range.usual > range.most")),
    Mutant("words are read beyond the last", DESCRIPTION, "words < kMostWords; ++w", "true; ++w"),
    Mutant("more words than there is room for are taken", DESCRIPTION, 'if (words >= kMostWords) add_mistake("it has too many words");', ""),

    Mutant("what is no file is loaded", REGISTRY, "if (!fs::is_regular_file(path, error))", "if (false)"),
    Mutant("more files than there are places", REGISTRY, "if (number == kMostFiles)", "if (false)"),
    Mutant("a module in trouble is loaded", REGISTRY, "if (!place.process.trouble().empty()) return place.process.trouble();", ""),
    Mutant("a module that describes itself wrongly is loaded", REGISTRY,
           "if (!place.description.mistake().empty()) return place.description.mistake();", ""),
    Mutant("any size of its memory", REGISTRY, "if (bytes > ROBOSYNC_MOST_BYTES)", "if (false)"),
    Mutant("no cost", REGISTRY, 'return sizes.cost == 0 ? "its cost() is 0" : "";', 'return "";'),
    Mutant("one that got into trouble is found again", REGISTRY,
           '  if (!place->process.trouble().empty()) return {nullptr, 0, place->process.trouble()};\n', ""),
    Mutant("a module in trouble asks for little", REGISTRY, "return {kTooMuch, kTooMuch, kTooMuch};", "return {};"),
    Mutant("who fails has not failed", REGISTRY, "    return ROBOSYNC_FAILED;\n", "    return 0;\n"),
    Mutant("numbers beyond the list", REGISTRY, "place >= module_files::kMostFiles || ", ""),
    Mutant("an empty place has a module", REGISTRY, " || module_files::places[place] == nullptr)", ")"),
)

SUITE = Suite("robosync_module_files", "tests/runtime-m4/test_module_files", "", MUTANTS)

if __name__ == "__main__":
    sys.exit(run(SUITE))
