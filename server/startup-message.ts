/** What to print when the page is being served: where it is, and how to open it on a headset. */
export function startupMessage({
  port,
  requestedPort,
  addresses,
  tokenFile = null,
}: {
  port: number;
  requestedPort: number;
  /** The machine's addresses when it serves the network, null when it serves itself alone. */
  addresses: readonly string[] | null;
  /** Where the experimenter's token lies; null: it was given, or there are no studies. */
  tokenFile?: string | null;
}): string {
  const lines = [''];
  if (requestedPort !== 0 && port !== requestedPort) lines.push(`  Port ${requestedPort} is taken; using ${port}.`, '');
  if (addresses === null) {
    lines.push(
      `  threepoint    http://localhost:${port}`,
      '',
      '  On a headset with a USB cable (developer mode on):',
      `    adb reverse tcp:${port} tcp:${port}    then open http://localhost:${port} in its browser`,
      '  On a headset over Wi-Fi:',
      '    npm start -- --lan',
    );
  } else {
    lines.push(`  threepoint    https://localhost:${port}`);
    for (const address of addresses) lines.push(`                https://${address}:${port}`);
    lines.push(
      '',
      addresses.length === 0
        ? '  This machine is on no network: connect it, then start again.'
        : '  On a headset in the same network: open one of the addresses with numbers in its browser.',
      '  The certificate is our own, so the browser warns once: Advanced, then Proceed.',
    );
  }
  lines.push(
    '',
    `  Studies       /experimenter and /results on the same address${tokenFile ? '; their token is in' : ''}`,
  );
  if (tokenFile) lines.push(`                ${tokenFile}`);
  lines.push(
    '',
    '  docs/running-on-a-headset.md has the steps and what to do when it does not open. Ctrl-C stops.',
    '',
  );
  return lines.join('\n');
}
