import type { ColorMode } from './color_modes';

/** What the user has chosen to see. */
export interface Settings {
  readonly mode: ColorMode;
  readonly uncoloredInPhotograph: boolean;
  readonly uncoloredElsewhere: boolean;
  readonly splatSize: number;
  readonly paraboloids: boolean;
  readonly eyeDome: boolean;
  readonly eyeDomeStrength: number;
  /** Points to draw at most; null: as many as go smoothly. */
  readonly fixedBudget: number | null;
  readonly trajectory: boolean;
  readonly foveal: boolean;
  readonly rays: boolean;
  readonly follow: boolean;
}

const basicSettings: Settings = {
  mode: 'photograph',
  uncoloredInPhotograph: false,
  uncoloredElsewhere: true,
  splatSize: 1,
  paraboloids: false,
  eyeDome: true,
  eyeDomeStrength: 0.4,
  fixedBudget: null,
  trajectory: true,
  foveal: false,
  rays: false,
  follow: true,
};

/** Without a graphics card splats stay flat, as bulging ones cost half as much again. */
export function defaultSettings(software: boolean): Settings {
  return { ...basicSettings, paraboloids: !software };
}

export function showsUncolored(settings: Settings): boolean {
  return settings.mode === 'photograph' ?
    settings.uncoloredInPhotograph : settings.uncoloredElsewhere;
}
