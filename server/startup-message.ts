/** Returns what the server prints once it listens: its addresses, and how to open the page on a headset. */
export function startupMessage({
  port,
  requestedPort,
  addresses,
  tokenFile = null,
}: {
  port: number;
  requestedPort: number;
  /** The machine's addresses on the network; null: it serves only itself. */
  addresses: readonly string[] | null;
  /** The file of the experimenter's token; null: the token is a setting. */
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
        ? '  This machine is on no network. Connect it, then start again.'
        : '  On a headset on the same network: open one of the addresses with digits in its browser.',
      '  The certificate is self-signed, so the browser warns once: choose Advanced, then Proceed.',
    );
  }
  lines.push(
    '',
    `  Studies       /experimenter and /results on the same address${tokenFile ? '; their token is in' : ''}`,
  );
  if (tokenFile) lines.push(`                ${tokenFile}`);
  lines.push(
    '',
    '  docs/running-on-a-headset.md lists the steps, and what to do if the page does not open. Ctrl-C stops the server.',
    '',
  );
  return lines.join('\n');
}
