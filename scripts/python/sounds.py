"""How scripts/rates prepares the sound for all modules that hear: recordings in a row, equally loud, and in equal noise.

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
LOUDEST = 3277  # root mean square of the loudest 20 ms: 20 dB below full scale
NOISES_DB = (40, 20, 10, 5)  # how far the noise is below that; 40: a quiet room


def raw(rate):
    """sox's options for this format."""
    return ("-r", str(rate), "-c", "1", "-b", "16", "-e", "signed", "-t", "raw", "-")


def as_loud(sound, rate):
    """Scales the sound so that its loudest 20 ms have the common loudness; None if it is silent."""
    block = rate // 50 * BYTES
    loudest = max((audioop.rms(sound[at:at + block], BYTES) for at in range(0, len(sound) - block + 1, block)), default=0)
    return audioop.mul(sound, BYTES, LOUDEST / loudest) if loudest else None


def noise(length, rate):
    """Pink noise, the same every time, as loud as the loudest 20 ms of a recording."""
    sound = subprocess.run(["sox", "-R", "-n", *raw(rate), "synth", "20", "pinknoise", "gain", "-12"], capture_output=True, check=True).stdout
    sound = audioop.mul(sound, BYTES, LOUDEST / audioop.rms(sound, BYTES))
    return (sound * (length // len(sound) + 1))[:length]


def mixed(sound, hiss, below):
    """The sound with the noise `below` dB below it."""
    return audioop.add(sound, audioop.mul(hiss[:len(sound)], BYTES, 10 ** (-below / 20)), BYTES)


def seconds(sound, rate):
    return len(sound) / BYTES / rate


def lay_out(paths, read, rate):
    """(all of them in a row, [(path, begin, end) in seconds]); read(path) returns None for a silent recording."""
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
    """The first two lines of a table; the columns after `first` are the noises."""
    return [f"| {first} | " + " | ".join(map(title, NOISES_DB)) + " |", "|---" + "|---" * (len(NOISES_DB) + first.count("|")) + "|"]
