import { expect, type Page } from '@playwright/test';
import { printFigures } from '../../tests/print-figures';
import { loudspeakerInstalled, startLoudspeaker } from '../loudspeaker';
import { bar, expectVoices, joinVoices, loudness, test } from '../talkers';

/** In the page: its microphone's echo is left as it is. */
function keepEcho(): void {
  const { mediaDevices } = navigator;
  const given = mediaDevices.getUserMedia.bind(mediaDevices);
  mediaDevices.getUserMedia = (constraints) => {
    const audio = typeof constraints?.audio === 'object' ? constraints.audio : {};
    return given({ audio: { ...audio, echoCancellation: false } });
  };
}

const unmute = (page: Page) => bar(page).getByRole('button', { name: 'Unmute me' }).click();

// A program of the distribution, not ours to install: apt-get install pulseaudio
test.describe(`echo${loudspeakerInstalled ? '' : ' (PulseAudio is not installed)'}`, () => {
  // biome-ignore lint/suspicious/noSkippedTests: reason: a program that the suite's name mentions is missing
  test.skip(!loudspeakerInstalled, 'PulseAudio is not installed: apt-get install pulseaudio');

  test('a placed voice from a loudspeaker returns 20 dB softer in the microphone than without cancelling @nightly', async ({
    serve,
    talker,
  }) => {
    test.setTimeout(600_000);
    const loudspeaker = await startLoudspeaker();
    try {
      const levels: Record<string, number> = {};
      for (const cancelling of [false, true]) {
        const { origin } = await serve();
        const { page: ann } = await talker(origin, 'Ann', { seldomDrawn: true, query: 'actor=off' });
        const { page: ben } = await talker(origin, 'Ben', {
          seldomDrawn: true,
          query: 'actor=off',
          device: loudspeaker.environment,
          ...(!cancelling && { inPage: keepEcho }),
        });
        await joinVoices(ann);
        await joinVoices(ben);
        await unmute(ann);
        await expectVoices(ben);
        await unmute(ben);
        // Ann receives her own voice, which Ben's page has played at her position: Ben is silent.
        if (!cancelling) await expectVoices(ann);
        // The canceller learns the way from loudspeaker to microphone from what goes by.
        await loudness(ann, 60);
        levels[cancelling ? 'with' : 'without'] = await loudness(ann, 40);
        levels.played = await loudness(ben, 15);
        for (const page of [ann, ben]) await page.close();
      }
      printFigures('echo [dB of full scale]', levels);
      expect((levels.without ?? Number.NaN) - (levels.with ?? Number.NaN)).toBeGreaterThan(20);
    } finally {
      await loudspeaker.close();
    }
  });
});
