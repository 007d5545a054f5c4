/** Message ports that keep this process running. */
export const openPorts = (): number => process.getActiveResourcesInfo().filter((name) => name === 'MessagePort').length;
