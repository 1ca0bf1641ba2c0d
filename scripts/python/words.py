"""How often command_words is right: words that people say in Debian's pocketsphinx-testdata, of twenty that it listens for.

scripts/companion --rates runs it. Each word that it hears and that nobody has said is a false alarm.
"""

import re
import subprocess
import sys
import tempfile
import wave
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/companion/bin/robosync-command-words"
DATA = Path("/usr/share/pocketsphinx/test/data")
WORDS = ("forward ten meters queen clubs seven eight spades hearts four "
         "hello stop robot dance back left right music goodbye faster").split()
USUAL = re.search(r"PARAMETER\(strict, \w+, (\d+)", (ROOT / "companion/modules.def").read_text())


def recordings(folder):
    """Each with what is said in it."""
    wav = Path(folder) / "goforward.wav"
    with wave.open(str(wav), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(16_000)
        out.writeframes((DATA / "goforward.raw").read_bytes())
    yield wav, "go forward ten meters"
    for kind, transcription in (("cards", "cards.transcription"), ("librivox", "transcription")):
        for said, name in re.findall(r"<s> (.*?) *</s> \((.*)\)", (DATA / kind / transcription).read_text()):
            yield DATA / kind / f"{name}.wav", said


def heard(recording):
    arguments = [part for word in WORDS for part in ("--word", word)]
    done = subprocess.run([PROGRAM, "--source", recording, "--no-pace", "--period", "60000", "--shown_for", "0.1", "--strict",
                           str(int(USUAL[1]) / 1000), *arguments], check=True, text=True, stdout=subprocess.PIPE)
    return [line.split()[1] for line in done.stdout.splitlines() if not line.endswith(" silence")]


def main():
    said_in_all, hits, false_alarms, seconds = 0, 0, 0, 0.0
    with tempfile.TemporaryDirectory(prefix="robosync-words-") as folder:
        for recording, said in recordings(folder):
            with wave.open(str(recording)) as file:
                seconds += file.getnframes() / file.getframerate()
            words = heard(recording)
            for word in said.split():
                if word in WORDS:
                    said_in_all += 1
                    if word in words:
                        words.remove(word)
                        hits += 1
            false_alarms += len(words)
    print(f"{hits} of {said_in_all} words heard, {false_alarms} false alarms in {seconds:.0f} s "
          f"({len(WORDS)} words, pocketsphinx-testdata)")


if __name__ == "__main__":
    sys.exit(main())
