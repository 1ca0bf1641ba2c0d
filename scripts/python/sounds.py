"""How scripts/rates makes what it plays, for all modules that hear: each recording as loud as the others, one behind the other, and in
as much noise.

Sound is bytes: 16 bits a sample, one channel, `rate` samples a second."""

import subprocess
import sys
import warnings
import wave

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # Debian 12's Python still has it
    import audioop

BYTES = 2
PAUSE_S = 1.5
LOUDEST = 3277  # root of the mean square of the loudest 20 ms: 20 dB below the loudest tone there is
NOISES_DB = (40, 20, 10, 5)  # how far the noise is below that; 40: a quiet room


def raw(rate):
    """How sox gives it."""
    return ("-r", str(rate), "-c", "1", "-b", "16", "-e", "signed", "-t", "raw", "-")


def as_loud(sound, rate):
    """As the others in its loudest 20 ms; None when nothing is heard."""
    block = rate // 50 * BYTES
    loudest = max((audioop.rms(sound[at:at + block], BYTES) for at in range(0, len(sound) - block + 1, block)), default=0)
    return audioop.mul(sound, BYTES, LOUDEST / loudest) if loudest else None


def noise(length, rate):
    """Pink, the same every time, as loud as the loudest 20 ms of a recording."""
    sound = subprocess.run(["sox", "-R", "-n", *raw(rate), "synth", "20", "pinknoise", "gain", "-12"], capture_output=True, check=True).stdout
    sound = audioop.mul(sound, BYTES, LOUDEST / audioop.rms(sound, BYTES))
    return (sound * (length // len(sound) + 1))[:length]


def mixed(sound, hiss, below):
    """With the noise so many dB below."""
    return audioop.add(sound, audioop.mul(hiss[:len(sound)], BYTES, 10 ** (-below / 20)), BYTES)


def seconds(sound, rate):
    return len(sound) / BYTES / rate


def lay_out(paths, read, rate):
    """(all of them behind each other, [(path, begin, end) in seconds]); read(path) gives None where nothing is heard."""
    pause = bytes(int(PAUSE_S * rate) * BYTES)
    sound, places = bytearray(2 * pause), []
    for path in paths:
        recording = read(path)
        if recording is None:
            print(f"left out, no sound: {path.name}", file=sys.stderr)
            continue
        begin = len(sound)
        sound += recording + pause
        places.append((path, begin / BYTES / rate, (begin + len(recording)) / BYTES / rate))
    return bytes(sound), places


def write(path, sound, rate):
    with wave.open(str(path), "wb") as file:
        file.setparams((1, BYTES, rate, 0, "NONE", ""))
        file.writeframes(sound)
    return path


def title(below):
    return "in a quiet room" if below == NOISES_DB[0] else f"noise {below} dB below"


def head(first):
    """The first two lines of a table, whose other columns are these."""
    return [f"| {first} | " + " | ".join(map(title, NOISES_DB)) + " |", "|---" + "|---" * (len(NOISES_DB) + first.count("|")) + "|"]
